#pragma once

#include <span>
#include <vector>

#include "collision/proximity.hpp"
#include "collision/response.hpp"
#include "collision/separation.hpp"
#include "physics/contact_energy.hpp"

namespace selvedge {

// The proximities of a step as terms of its incremental potential. nodes0, nodes1: all nodes at the step's start, and
// with obstacles where they end. A pair's stiffness is `contact_stiffness` times its mass over h^2, which makes a
// layer's own weight sink it by the same small fraction of g h^2 at any density, scale or time step; its force vanishes
// where a tenth of the overlap is gone, so that no pair is thrown apart (Bridson, Fedkiw and Anderson 2002,
// section 7.2). Pairs farther apart than their rest gap are stopped there.
std::vector<ContactTerm> contact_terms(const Scene&, const ContactWorld&, std::span<const Proximity>,
                                       const Eigen::VectorXd& inverse_mass, const Points& nodes0, const Points& nodes1,
                                       double h);

// Impacts that a first solve would run into, as terms of a second one, so that the whole cloth gives way and not the
// four vertices alone. They stop half the thickness away, or where they are if that is nearer. Pairs that `terms` holds
// already keep their one owner.
void add_impact_terms(const Scene&, const ContactWorld&, std::span<const Impact>, std::span<const Proximity> owned,
                      const Eigen::VectorXd& inverse_mass, const Points& nodes0, const Points& nodes1, double h,
                      std::vector<ContactTerm>& terms);

// Separations as terms without friction, as stiff as contacts; softness [m]. Those of more than four vertices are left
// out.
std::vector<ContactTerm> push_terms(std::span<const Separation>, const Eigen::VectorXd& inverse_mass, double softness,
                                    double h);

// Sets the normal forces that bound friction from the gaps at x [N].
void lag_normal_forces(std::vector<ContactTerm>&, const Points& x);

// Takes from the pairs' slip what Coulomb friction still allows beyond what the solve has used, all of it where the
// pair sticks: the lagged potential alone would creep. Moves x, by Gauss-Seidel over the pairs.
void stick(std::span<const ContactTerm>, const Eigen::VectorXd& inverse_mass, const Points& x0, double h,
           double slip_width, Points& x);

}  // namespace selvedge

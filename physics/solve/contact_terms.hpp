#pragma once

#include <span>
#include <vector>

#include "collision/contact/proximity.hpp"
#include "collision/contact/response.hpp"
#include "collision/untangle/separation.hpp"
#include "physics/energies/contact_energy.hpp"
#include "physics/solve/contact_term_options.hpp"
#include "physics/solve/implicit_euler.hpp"

namespace selvedge {

// Contacts of a step, each with the pair that owns it.
struct Contacts {
  std::vector<NodePair> pairs;
  std::vector<ContactTerm> terms;
};

// The proximities of a step as terms of its incremental potential. nodes0, nodes1: all nodes at the step's start, and
// with obstacles where they end. A pair's stiffness begins with a multiple of its mass over h^2, which
// makes a layer's own weight sink it by the same small fraction of g h^2 at any density, scale or time step; its force
// vanishes where a tenth of the overlap is gone, so that no pair is thrown apart (Bridson, Fedkiw and Anderson 2002,
// section 7.2). Pairs farther apart than their rest gap are stopped there.
Contacts contact_terms(const Scene&, const ContactWorld&, std::span<const Proximity>,
                       const Eigen::VectorXd& inverse_mass, const Points& nodes0, const Points& nodes1, double h,
                       const ContactTermOptions& = {});

// Impacts that a solve has run into, as terms of the next one, so that the whole cloth gives way and not the four
// vertices alone. They stop half the thickness away, or where they are if that is nearer. A pair that has a term keeps
// it, but is linearised anew where its impact is deeper than `deep` [m].
void add_impact_terms(const Scene&, const ContactWorld&, std::span<const Impact>, const Eigen::VectorXd& inverse_mass,
                      const Points& nodes0, const Points& nodes1, double h, double deep, Contacts&,
                      const ContactTermOptions& = {});

// What a separation gives under a unit impulse [1/kg]. 0 where no free vertex has a weight of 0.01: it would go a
// hundred times as far as the separation.
double push_compliance(const Separation&, const Eigen::VectorXd& inverse_mass);

// Separations as terms without friction, as stiff as contacts; softness [m]. Those of more than four vertices and those
// that give nothing are left out.
std::vector<ContactTerm> push_terms(std::span<const Separation>, const Eigen::VectorXd& inverse_mass, double softness,
                                    double h, const ContactTermOptions& = {});

// Terms without friction as one of the potential, for solves that have contacts beside them.
AddedTerm added_pushes(std::vector<ContactTerm>);

// Sets the normal forces that bound friction from the gaps at x [N]. Returns by how much of it their sum has changed,
// each times its friction.
double lag_normal_forces(std::vector<ContactTerm>&, const Points& x);

// Root mean square of a motion over what the terms hold, vertex by vertex as often as held; 0 without terms.
double mean_touching(std::span<const ContactTerm>, const Points& motion);

// How wrong friction at x is, in a solve with the terms `solved`, by the normal forces found there: the sum of what is
// too much, and of what is missing where the pair slides, over the sum of what is allowed. `lagged`: the same terms
// with those forces.
double mistaken_friction(std::span<const ContactTerm> solved, std::span<const ContactTerm> lagged, const Points& x0,
                         const Points& x, double slip_width);

// Linearises terms anew at the ends nodes1 that a solve has found, so that forces act where the step ends, as implicit
// Euler has it: with those of the start, sliding round a bend is braked. Pairs that have changed sides stay as they
// are.
void relinearise(const Scene&, const ContactWorld&, const Eigen::VectorXd& inverse_mass, const Points& nodes0,
                 const Points& nodes1, double h, Contacts&, const ContactTermOptions& = {});

// Makes terms as stiff as they must be to bear the forces on the cloth's vertices [N] without sinking more than they
// may.
void set_load_stiffness(std::vector<ContactTerm>&, const Eigen::VectorXd& inverse_mass, const Points& forces,
                        const ContactTermOptions& = {});

// Makes terms that their load has pressed deeper than they may sink as stiff as that load asks for, so that tight cloth
// is held by the solve and not by impulses.
void raise_stiffness(std::vector<ContactTerm>&, const Points& x);

// Takes from the pairs' slip what Coulomb friction still allows beyond what the solve has used, all of it where the
// pair sticks: the lagged potential alone would creep. Moves x, by Gauss-Seidel over the pairs.
void apply_static_friction(std::span<const ContactTerm>, const Eigen::VectorXd& inverse_mass, const Points& x0,
                           double h, double slip_width, Points& x, const ContactTermOptions& = {});

}  // namespace selvedge

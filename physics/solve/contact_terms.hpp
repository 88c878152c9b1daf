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

// The motion for which contacts are linearised. Refers to its scene, world, masses and nodes.
struct ContactMotion {
  const Scene& scene;
  const ContactWorld& world;
  const Eigen::VectorXd& inverse_mass;  // of all nodes [1/kg]
  const Points& nodes0;                 // at the start [m]
  const Points& nodes1;                 // with obstacles at their ends, and the cloth where it is now [m]
  double h;                             // length [s]
  ContactTermOptions options = {};
};

// The proximities of a step as terms of its incremental potential. A pair's stiffness begins with a multiple of its
// mass over h^2. So a layer sinks under its own weight by the same small fraction of g h^2 at any density, scale or
// time step. The force vanishes once a tenth of the overlap is gone, so that no pair is thrown apart (Bridson, Fedkiw
// and Anderson 2002, section 7.2); in steps below a millisecond even less, in proportion. Pairs farther apart than
// their rest gap are stopped there.
Contacts contact_terms(const ContactMotion&, std::span<const Proximity>);

// Adds impacts that a solve has run into as terms of the next solve, so that the whole cloth gives way and not the four
// vertices alone. Such a pair is stopped at half the thickness, or at its present distance if that is less. A pair that
// has a term already keeps it; if its impact is deeper than `deep` [m], the term is linearised anew.
void add_impact_terms(const ContactMotion&, std::span<const Impact>, double deep, Contacts&);

// The inverse effective mass of a separation [1/kg]. 0 if no free vertex has a weight of at least 0.01, since it would
// have to move a hundred times as far as the separation.
double push_compliance(const Separation&, const Eigen::VectorXd& inverse_mass);

// Separations as terms without friction, as stiff as contacts; softness [m]. Leaves out those of more than four
// vertices and those with compliance 0.
std::vector<ContactTerm> push_terms(std::span<const Separation>, const Eigen::VectorXd& inverse_mass, double softness,
                                    double h, const ContactTermOptions& = {});

// Terms without friction as one added term of the potential, for solves that have contacts too.
AddedTerm added_pushes(std::vector<ContactTerm>);

// Sets the normal forces that bound friction from the gaps at x [N]. Returns the relative change of the sum of friction
// coefficient times normal force.
double lag_normal_forces(std::vector<ContactTerm>&, const Points& x);

// Root mean square of a motion over the terms' vertices, each counted as often as terms have it; 0 without terms.
double mean_touching(std::span<const ContactTerm>, const Points& motion);

// The relative error of friction at x after a solve with the terms `solved`. `lagged`: the same terms with the normal
// forces found at x, which bound friction. The error sums friction beyond its bound, and what is missing to the bound
// where a pair slides, and divides by the sum of the bounds.
double mistaken_friction(std::span<const ContactTerm> solved, std::span<const ContactTerm> lagged, const Points& x0,
                         const Points& x, double slip_width);

// Linearises terms anew at the ends nodes1 that a solve has found, so that forces act at the step's end, as implicit
// Euler requires: with directions from the start, sliding round a bend would be braked. Pairs that have changed sides
// stay as they are.
void relinearise(const ContactMotion&, Contacts&);

// Makes terms stiff enough to bear the forces on the cloth's vertices [N] without sinking more than allowed
// (load_sink).
void set_load_stiffness(std::vector<ContactTerm>&, const Eigen::VectorXd& inverse_mass, const Points& forces,
                        const ContactTermOptions& = {});

// Raises the stiffness of terms that their load has pressed deeper than allowed, to what the load needs, so that tight
// cloth is held by the solve and not by impulses.
void raise_stiffness(std::vector<ContactTerm>&, const Points& x);

// Reduces the pairs' slip by as much as Coulomb friction allows beyond what the solve has used, to zero where the pair
// sticks: with the lagged potential alone pairs would creep. Moves x, by Gauss-Seidel over the pairs. `forces` gets
// what that exerts on each vertex, added to its rows [N].
void apply_static_friction(std::span<const ContactTerm>, const Eigen::VectorXd& inverse_mass, const Points& x0,
                           double h, double slip_width, Points& x, const ContactTermOptions& = {},
                           Points* forces = nullptr);

}  // namespace selvedge

#pragma once

#include <span>

#include "physics/energies/contact_energy.hpp"
#include "physics/scene/contact_forces.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// How the solve of a substep ended, as far as contact forces follow from it.
struct SolvedContacts {
  std::span<const ContactTerm> terms;      // with the normal forces at x
  std::span<const double> friction_loads;  // the normal force of each term that bounded its friction in the solve [N]
  const Points &x0, &x;                    // the cloth at the start and at the end of the solve
  double slip_width = 0;                   // of friction [m]
};

// The forces of a solve's contacts on each vertex: the normal forces at its end, its friction, and the further friction
// `sticking` [N] that keeps pairs from creeping (apply_static_friction). Impulses of the response, which meet what the
// solve leaves of impacts, are not among them, and neither are forces that part tangled cloth.
// The pressure counts the forces on the front and on the back of the cloth apart, so that a layer between two others
// has one although the forces on it cancel. It divides by a third of the rest area of the triangles at the vertex.
ContactForces forces_of_terms(const Scene&, const SolvedContacts&, const Points& sticking);

}  // namespace selvedge

#pragma once

#include <vector>

#include "collision/contact/contact_world.hpp"
#include "physics/recovery/recovery_options.hpp"
#include "physics/recovery/untangling_budget.hpp"

namespace selvedge {

// Springs (drawn.hpp) draw cloth only to within a millimetre of its skinned targets, which is not enough where it fits
// closer to the body than that. So cloth that is near its targets is set to them.

// Where bodies and obstacles would take the cloth in a step.
struct RecoveryTargets {
  const Points* wanted;           // all nodes, with obstacles at the step's end
  const Points* skinned_targets;  // the cloth's then, a row a vertex
  Points last_clean;              // all nodes when the cloth was last clean; empty: never
  double thickness;               // of contact [m]
  double h;                       // of the step [s]
  std::vector<char> apart = {};   // 1 for obstacles that are known not to cross themselves at the step's end; empty:
                                  // nothing is known
};

enum class PutOn { nothing, too_far, no_place, done };

// Moves the marked vertices of the cloth to their skinned targets at the start of a step and untangles them there.
// Their velocities become those of the nearest obstacle nodes. A second place is where they were last clean, moved
// along since (carried_along.hpp); the place with fewer crossing triangles is tried first. Other cloth may be moved by
// untangling, and keeps its velocity. Overwrites `nodes` (at the start) and the cloth's velocities v. Both stay as they
// were if nothing is marked (`nothing`), if a marked vertex would move too far (`too_far`), or if the passes do not
// untangle it at any place (`no_place`). All positions must be finite, targets at marked vertices. Without a budget an
// ample one is used.
PutOn put_on(const ContactWorld&, const std::vector<char>& marked, const RecoveryTargets&, Points& nodes, Points& v,
             UntanglingBudget* = nullptr, const RecoveryOptions& = {});

}  // namespace selvedge

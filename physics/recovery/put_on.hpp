#pragma once

#include <vector>

#include "collision/contact/contact_pairs.hpp"
#include "physics/recovery/recovery_options.hpp"
#include "physics/recovery/untangling_budget.hpp"

namespace selvedge {

// Springs (carrying.hpp) take cloth near to its skinned targets, but leave it a millimetre off, and so in the body
// wherever it is worn that close. So cloth that is near is set to them.

// Where cloth is taken in a step: by the body that wears it, or by obstacles that it was clean beside.
struct WornPlaces {
  const Points* wanted;  // all nodes, with obstacles at the step's end
  const Points* worn;    // the cloth's skinned targets then, a row a vertex
  Points last_clean;     // all nodes when the cloth was clean last; empty: it never was
  double thickness;      // of contact [m]
  double h;              // of the step [s]
};

enum class PutOn { nothing, too_far, no_place, done };

// Puts the marked vertices of the cloth on their skinned targets at the start of a step, untangled there, and has them
// move along with the obstacle's node that is nearest. Where they were clean last, carried along since
// (carried_along.hpp), is a second place; the one with fewer crossing triangles is tried first. Cloth that is not
// marked makes way, and keeps its velocity. `nodes`, at the start, and the cloth's velocities v are overwritten. Both
// stay as they were if nothing is marked, if a marked vertex would go farther than it may, or if there is no place:
// the passes that it may take do not untangle it. Cloth without one is better off where it is.
// All must be finite, what is worn where it is marked. No budget: an ample one.
PutOn put_on(const ContactWorld&, const std::vector<char>& marked, const WornPlaces&, Points& nodes, Points& v,
             UntanglingBudget* = nullptr, const RecoveryOptions& = {});

}  // namespace selvedge

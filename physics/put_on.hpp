#pragma once

#include <vector>

#include "collision/contact_pairs.hpp"

namespace selvedge {

// Springs (carrying.hpp) take cloth near to where it is worn, but leave it a millimetre off, and so in the body
// wherever it is worn that close. The last of the way is not left to them.

enum class PutOn { nothing, too_far, no_place, done };

// Puts the marked vertices of the cloth to where they are worn at the start of a step, untangled there, and has them
// move along with the obstacle's node that is nearest. Cloth that is not marked makes way, and keeps its velocity.
// `wanted` has the obstacles at the step's end, h [s] later, and `worn` is where the cloth is worn then; `nodes`, at
// the start, and the cloth's velocities v are overwritten. Both stay as they were if nothing is marked, if a marked
// vertex would go farther than 0.3 m, or if there is no place: a hundred iterations do not untangle it, fewer from a
// thousand pairs on. Cloth without one is better off where it is. All must be finite, `worn` where it is marked.
PutOn put_on(const ContactWorld&, const std::vector<char>& marked, const Points& wanted, const Points& worn, double h,
             Points& nodes, Points& v);

}  // namespace selvedge

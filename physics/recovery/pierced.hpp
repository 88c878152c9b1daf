#pragma once

#include <vector>

#include "collision/contact/exemption.hpp"
#include "physics/recovery/recovery_options.hpp"

namespace selvedge {

// Cloth that a limb has gone through, as happens where a body passed through itself, would hang on the limb for good:
// it could leave only over the limb's end. Once the body is free of itself again, all such cloth is put on
// (put_on.hpp), or drawn to its skinned targets through the body (drawn.hpp).

// 1 for each vertex of a pierced component of the cloth; empty if there is none. A component is pierced if a contour
// with an obstacle cuts a patch out of it that lies inside the obstacle as a whole, and goes round a part of the
// obstacle that is long for its width. (An open obstacle has an inside only for patches without vertices.) It also
// counts as pierced while enough of its vertices are tangled with obstacles and more than `min_distance` [m] from their
// skinned targets, so that cloth which is drawn is not taken for sunken cloth. Components with vertices that no body
// wears are left out, and those that an obstacle would go through at their targets too. Empty also where an obstacle
// crosses itself. `exemption`: what is tangled and switched off at `nodes`. `wanted`: obstacles at the step's end.
std::vector<char> pierced_vertices(const ContactWorld&, const Exemption& exemption, const Points& nodes,
                                   const Points& wanted, const Points& targets, double min_distance,
                                   const RecoveryOptions& = {});

// 1 for each vertex of a sunken component of the cloth; empty if there is none: a small part of its vertices is tangled
// with an obstacle that does not cross itself, as may be left after cloth was drawn. All of it may be put on again
// (put_on.hpp).
std::vector<char> sunken_vertices(const ContactWorld&, const Exemption&, const Points& targets,
                                  const RecoveryOptions& = {});

}  // namespace selvedge

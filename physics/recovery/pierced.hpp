#pragma once

#include <vector>

#include "collision/contact/exemption.hpp"
#include "physics/recovery/recovery_options.hpp"

namespace selvedge {

// Cloth that a limb has gone through, as happens where a body passed through itself, hangs on the limb for good: there
// is no way out for it but over the limb's end. Where the body is free of itself again, all of such cloth is put on
// (put_on.hpp), or drawn to its skinned targets through the body (carrying.hpp).

// The worn vertices of the components of the cloth that an obstacle goes through: it has a contour with the obstacle
// that cuts a patch out of the cloth which lies in the obstacle as a whole (an open one has an inside only for patches
// without vertices), and that goes round a part of the obstacle which is long for its width. And of those of
// which a part of the vertices is tangled with obstacles more than `astray` [m] from the skinned targets: until they
// are there, lest cloth that is drawn is taken for cloth that has only sunk in. Not those whose targets an obstacle
// goes through as well, nor where an obstacle crosses itself. `exemption` is what is tangled and switched off at
// `nodes`; `wanted` has the obstacles at the step's end. 1 a vertex of the cloth; empty where there is none.
std::vector<char> pierced_vertices(const ContactWorld&, const Exemption& exemption, const Points& nodes,
                                   const Points& wanted, const Points& worn, double astray,
                                   const RecoveryOptions& = {});

// The worn vertices of the components of the cloth of which a small part is tangled with an obstacle that
// does not cross itself: what is left of such a passage, once drawn near, is of no one kind. All of it may be put on
// again (put_on.hpp). 1 a vertex of the cloth; empty where there is none.
std::vector<char> sunken_vertices(const ContactWorld&, const Exemption&, const Points& worn,
                                  const RecoveryOptions& = {});

}  // namespace selvedge

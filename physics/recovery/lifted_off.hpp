#pragma once

#include "collision/contact/contact_world.hpp"

namespace selvedge {

// The cloth with the `tangled` vertices that lie on an obstacle, to within a millionth of the cloth's mean edge, moved
// by `gap` mean edges to the side to which the obstacle's faces point there: cloth exactly in a surface does not cross
// it, so that untangling would find no side. All others stay, `held` ones too. Returns a row for each cloth vertex [m].
Points lifted_off(const ContactWorld&, const Points& nodes, const std::vector<char>& tangled,
                  const std::vector<char>& held, double gap);

}  // namespace selvedge

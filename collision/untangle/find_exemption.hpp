#pragma once

#include "collision/contact/exemption.hpp"

namespace selvedge {

// Contours of the cloth with itself (where world.self) and with the obstacles, and its vertices inside closed
// obstacles. Positions must be finite.
Exemption find_exemption(const ContactWorld&, const Points& nodes);

// Adds to `off` what an obstacle's crossing of itself switches off at these positions.
void switch_off(const ContactWorld&, int obstacle, const Points& nodes, Exemption&);

}  // namespace selvedge

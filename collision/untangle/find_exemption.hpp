#pragma once

#include "collision/contact/exemption.hpp"

namespace selvedge {

// Contours of the cloth with itself (where world.self) and with the obstacles, and its vertices inside closed shells
// of obstacles. Positions must be finite.
Exemption find_exemption(const ContactWorld&, const Points& nodes);

}  // namespace selvedge

#pragma once

#include "collision/contact/exemption.hpp"

namespace selvedge {

// Marks cloth vertices on or inside contours of the cloth with itself (where world.self), on contours with obstacles,
// and inside closed shells of obstacles. Positions must be finite.
Exemption find_exemption(const ContactWorld&, const Points& nodes);

}  // namespace selvedge

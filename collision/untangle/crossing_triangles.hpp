#pragma once

#include "collision/contact/contact_world.hpp"

namespace selvedge {

// For each triangle of the cloth, 1 if it meets another one (where world.self), crosses one with which it shares a
// vertex, meets an obstacle, or has a vertex inside a closed obstacle. Positions must be finite.
std::vector<char> crossing_triangles(const ContactWorld&, const Points& nodes);

}  // namespace selvedge

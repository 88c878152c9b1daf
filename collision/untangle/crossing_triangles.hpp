#pragma once

#include "collision/contact/contact_pairs.hpp"

namespace selvedge {

// Of each triangle of the cloth, 1 where it meets another one (where world.self), crosses one that it shares a vertex
// with, meets an obstacle, or has a vertex inside a closed one. Positions must be finite.
std::vector<char> crossing_triangles(const ContactWorld&, const Points& nodes);

}  // namespace selvedge

#pragma once

#include <vector>

#include "collision/contact/contact_world.hpp"

namespace selvedge {

// Where the cloth of `before` would be if it had moved with the obstacles from there to their places in `nodes`. A
// vertex moves with the obstacle node that is nearest in `before`; the farther it is from that node, the more it moves
// with the cloth round it. The displacements u minimise sum |u_a - u_b|^2 over edges + sum (e / d)^2 |u - u_nearest|^2
// over vertices, with the mean edge length e and the distance d, at least `thickness` [m]. Both arguments have all
// nodes of the world, finite, with at least one obstacle. Returns one row per vertex of the cloth.
Points carried_along(const ContactWorld&, const Points& before, const Points& nodes, double thickness);

// The obstacle nodes nearest to places (rows), as nodes of the world; the lowest on a tie.
std::vector<int> nearest_obstacle_nodes(const ContactWorld&, const Points& nodes, const Points& places);

}  // namespace selvedge

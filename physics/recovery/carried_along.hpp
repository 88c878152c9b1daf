#pragma once

#include "collision/contact/contact_pairs.hpp"

namespace selvedge {

// Where the cloth of `before` would be if obstacles had taken it along from there to where they are in `nodes`: a
// vertex goes with the obstacles' node that is nearest in `before`, and the farther it is from that one, the more with
// the cloth round it: the displacements u minimise sum |u_a - u_b|^2 over edges + sum (e / d)^2 |u - u_nearest|^2 over
// vertices, with the mean edge length e and the distance d, which counts as the thickness [m] where it is less. Both in
// world order and finite, with an obstacle. One row a vertex of the cloth.
Points carried_along(const ContactWorld&, const Points& before, const Points& nodes, double thickness);

// The obstacles' node nearest to a place, in world order; the lowest on a tie.
int nearest_obstacle_node(const ContactWorld&, const Points& nodes, const Vec3& place);

}  // namespace selvedge

#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Cuts a polygon of n >= 3 corners into n - 2 triangles of indices of its corners. Takes the fan from the first corner
// if every triangle of it has area and faces as the polygon does. Otherwise cuts off ears, the best shaped first; none
// is without area if the polygon has such a triangulation. Polygons need not be flat or convex. One without area, or
// with more corners than `most_eared_corners`, becomes a fan. A flat quad whose edges cross is cut as the one with the
// same corners whose edges do not.
inline constexpr std::size_t most_eared_corners = 2000;
std::vector<std::array<int, 3>> polygon_triangles(std::span<const Vec3> corners);

// How many quads of a mesh have edges that cross; arguments as below.
int crossed_quads(const Points& x, const std::vector<int>& corners, const std::vector<int>& begin);

// Cuts the polygons of a mesh so, into triangles of indices of `corners`, which are vertices. `begin`: where each
// polygon begins among them; the last one ends with them. A polygon that lies on an earlier one, corner on corner, as
// the back of a two-sided face does, is cut along the same diagonals.
Triangles cut_polygons(const Points& x, const std::vector<int>& corners, const std::vector<int>& begin);

}  // namespace selvedge

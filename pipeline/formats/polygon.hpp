#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// A polygon of n >= 3 corners cut into n - 2 triangles, corners by their place in it: the fan from the first corner
// where every triangle of it has area and faces as the polygon does, else by ears, the best shaped first, of which none
// is without area if the polygon has a triangulation of that kind. Polygons need not be flat or convex. One without
// area, and one of more corners than `most_eared_corners`, is fanned.
inline constexpr std::size_t most_eared_corners = 2000;
std::vector<std::array<int, 3>> polygon_triangles(std::span<const Vec3> corners);

}  // namespace selvedge

#pragma once

#include <span>
#include <utility>
#include <vector>

#include "collision/search/bvh_traversal.hpp"
#include "collision/search/quiet.hpp"

namespace selvedge {

// What is kept of one surface between calls: a tree that is refitted, and its flat parts. It changes nothing but the
// time of a call.
struct IntersectionCache {
  bool cull = true;  // skip parts that cannot intersect themselves (quiet.hpp)
  KeptBvh tree;
  QuietParts parts;
  std::vector<Box> boxes;
  PartLists<std::pair<int, int>> lists;
};

// Discrete detection for the solver, not for the audit: pairs of triangles of a surface that intersect and share no
// vertex, by exact signs (triangles_meet). Each pair is listed once with i < j, sorted. A triangle with an undefined
// coordinate intersects nothing. Throws TooManyPairs (pair_budget.hpp).
std::vector<std::pair<int, int>> intersecting_pairs(const Surface&, const Points& x, IntersectionCache&);

// The same between two surfaces: (triangle of a, triangle of b), sorted. Each surface has a cache of its own.
std::vector<std::pair<int, int>> intersecting_pairs(const Surface& a, const Points& xa, IntersectionCache& cache_a,
                                                    const Surface& b, const Points& xb, IntersectionCache& cache_b);

// True only if a plane lies strictly between the two triangles: a quick floating-point test with a bound on its
// rounding, which decides most pairs. False says nothing.
bool surely_apart(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

// A face's plane through its first corner, kept where many pairs ask for it.
struct FacePlane {
  Vec3 on, normal;   // normal: as long as twice the face's area
  double reach = 0;  // largest sum of coordinates of the other corners, seen from the first
};
FacePlane face_plane(const std::array<Vec3, 3>& face);

// True only if the points, one at least, are strictly on one side of the face's plane. False says nothing.
bool surely_on_one_side(const FacePlane&, std::span<const Vec3> points);

}  // namespace selvedge

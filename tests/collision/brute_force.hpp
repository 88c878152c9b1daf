#pragma once

#include <array>
#include <utility>
#include <vector>

#include "collision/audit/audit_pair.hpp"
#include "collision/geometry/surface.hpp"

namespace selvedge::testing {

// Tests compare searches with all pairs of triangles. A mesh is anything with a surface and positions x.

using Corners = std::array<Vec3, 3>;
using Pairs = std::vector<std::pair<int, int>>;

// The audit's answer in the form of the solver's triangles_meet.
inline bool audit_sees_meet(const Corners& a, const Corners& b) {
  return triangles_intersect(a[0], a[1], a[2], b[0], b[1], b[2]);
}

template <class Mesh>
Corners corners(const Mesh& m, int t) {
  return {row(m.x, m.surface.triangles(t, 0)), row(m.x, m.surface.triangles(t, 1)),
          row(m.x, m.surface.triangles(t, 2))};
}

// Pairs of triangles without a common vertex for which meet(corners, corners) is true.
template <class Mesh, class Meet>
Pairs brute_self(const Mesh& m, const Meet& meet) {
  Pairs pairs;
  const Triangles& t = m.surface.triangles;
  for (int i = 0; i < t.rows(); ++i)
    for (int j = i + 1; j < t.rows(); ++j) {
      bool share = false;
      for (int k = 0; k < 9; ++k) share |= t(i, k / 3) == t(j, k % 3);
      if (!share && meet(corners(m, i), corners(m, j))) pairs.emplace_back(i, j);
    }
  return pairs;
}

template <class Mesh, class Meet>
Pairs brute_cross(const Mesh& a, const Mesh& b, const Meet& meet) {
  Pairs pairs;
  for (int i = 0; i < a.surface.triangles.rows(); ++i)
    for (int j = 0; j < b.surface.triangles.rows(); ++j)
      if (meet(corners(a, i), corners(b, j))) pairs.emplace_back(i, j);
  return pairs;
}

}  // namespace selvedge::testing

#pragma once

#include <array>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge::closed {

// Volumes by brute force in long double, for tests. A closed surface is the signed sum of the tetrahedra between its
// faces and a point, and the volume that two surfaces wind round is that of the overlaps of their tetrahedra. Two
// different points put the tetrahedra of one surface and itself in general position.
using Exactly = Eigen::Matrix<long double, 3, 1>;
using Cone = std::array<Exactly, 4>;

inline long double signed_volume(const Cone& t) { return (t[1] - t[0]).cross(t[2] - t[0]).dot(t[3] - t[0]) / 6; }

// Appends the part of the tetrahedron above the plane of a, b, c, on the side of d.
inline void clip_cone(const Cone& t, const Exactly& a, const Exactly& normal, std::vector<Cone>& out) {
  std::array<long double, 4> height;
  std::vector<int> above, below;
  for (int k = 0; k < 4; ++k) {
    height[k] = normal.dot(t[k] - a);
    (height[k] > 0 ? above : below).push_back(k);
  }
  const auto cut = [&](int i, int j) -> Exactly {
    return t[i] + (t[j] - t[i]) * (height[i] / (height[i] - height[j]));
  };
  const auto add_prism = [&](const std::array<Exactly, 3>& p, const std::array<Exactly, 3>& q) {
    out.push_back({p[0], p[1], p[2], q[0]});
    out.push_back({p[1], p[2], q[0], q[1]});
    out.push_back({p[2], q[0], q[1], q[2]});
  };
  if (above.size() == 4) {
    out.push_back(t);
  } else if (above.size() == 3) {
    const int d = below[0];
    add_prism({t[above[0]], t[above[1]], t[above[2]]}, {cut(above[0], d), cut(above[1], d), cut(above[2], d)});
  } else if (above.size() == 2) {
    const int a0 = above[0], a1 = above[1], b0 = below[0], b1 = below[1];
    add_prism({t[a0], cut(a0, b0), cut(a0, b1)}, {t[a1], cut(a1, b0), cut(a1, b1)});
  } else if (above.size() == 1) {
    const int i = above[0];
    out.push_back({t[i], cut(i, below[0]), cut(i, below[1]), cut(i, below[2])});
  }
}

inline long double overlap_volume(const Cone& s, const Cone& t) {
  std::vector<Cone> pieces{s}, next;
  for (int k = 0; k < 4; ++k) {
    const Exactly &a = t[(k + 1) % 4], &b = t[(k + 2) % 4], &c = t[(k + 3) % 4];
    Exactly normal = (b - a).cross(c - a);
    if (normal.dot(t[k] - a) < 0) normal = -normal;
    next.clear();
    for (const Cone& piece : pieces) clip_cone(piece, a, normal, next);
    pieces.swap(next);
  }
  long double sum = 0;
  for (const Cone& piece : pieces) sum += std::abs(signed_volume(piece));
  return sum;
}

inline std::vector<Cone> cones_of(const Points& x, const Triangles& triangles, const Vec3& apex) {
  std::vector<Cone> cones;
  for (const auto& t : triangles.rowwise())
    cones.push_back({apex.cast<long double>(), row(x, t[0]).cast<long double>(), row(x, t[1]).cast<long double>(),
                     row(x, t[2]).cast<long double>()});
  return cones;
}

inline double mesh_volume(const Points& x, const Triangles& triangles) {
  long double sum = 0;
  for (const Cone& t : cones_of(x, triangles, row(x, 0))) sum += signed_volume(t);
  return static_cast<double>(sum);
}

// The integral of the product of both winding numbers.
inline double common_volume(const std::vector<Cone>& a, const std::vector<Cone>& b) {
  long double sum = 0;
  for (const Cone& s : a)
    for (const Cone& t : b) {
      bool apart = false;
      for (int k = 0; k < 3 && !apart; ++k) {
        const auto [s_lo, s_hi] = std::minmax({s[0][k], s[1][k], s[2][k], s[3][k]});
        const auto [t_lo, t_hi] = std::minmax({t[0][k], t[1][k], t[2][k], t[3][k]});
        apart = s_lo >= t_hi || t_lo >= s_hi;
      }
      const long double sign_s = signed_volume(s), sign_t = signed_volume(t);
      if (apart || sign_s == 0 || sign_t == 0) continue;
      sum += ((sign_s < 0) == (sign_t < 0) ? 1 : -1) * overlap_volume(s, t);
    }
  return static_cast<double>(sum);
}

}  // namespace selvedge::closed

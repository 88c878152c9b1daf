#pragma once

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "tests/collision/sheets.hpp"

namespace selvedge::closed {

using Solid = testing::Sheet;

inline Solid both(const Solid& a, const Solid& b) { return testing::join(a, b); }

inline Solid moved(Solid s, const Vec3& by) {
  s.x.rowwise() += by.transpose();
  return s;
}

inline Solid turned(Solid s, const Vec3& axis, double angle) {
  s.x *= Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix().transpose();
  return s;
}

inline Solid flipped(Solid s) {
  s.triangles.col(1).swap(s.triangles.col(2));
  return s;
}

inline Solid box(const Vec3& lo, const Vec3& hi) {
  Solid s{Points(8, 3), Triangles(12, 3)};
  for (int v = 0; v < 8; ++v)
    for (int k = 0; k < 3; ++k) s.x(v, k) = v >> k & 1 ? hi[k] : lo[k];
  s.triangles << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3,
      7, 5;
  return s;
}

inline Solid tetrahedron(const std::array<Vec3, 4>& corner) {
  Solid s{Points(4, 3), Triangles(4, 3)};
  for (int v = 0; v < 4; ++v) s.x.row(v) = corner[v].transpose();
  s.triangles << 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2;
  if ((corner[1] - corner[0]).cross(corner[2] - corner[0]).dot(corner[3] - corner[0]) < 0) return flipped(s);
  return s;
}

// An icosahedron with each face divided in four, `times` over, on the unit sphere: 20 x 4^times faces.
inline Solid ball(int times) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> x{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3& at : x) at.normalize();
  std::vector<std::array<int, 3>> faces{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                        {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                        {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                        {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (; times > 0; --times) {
    std::map<std::pair<int, int>, int> middle;
    const auto between = [&](int a, int b) {
      const auto [at, is_new] = middle.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(x.size()));
      if (is_new) x.push_back(Vec3(x[a] + x[b]).normalized());
      return at->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const int ab = between(a, b), bc = between(b, c), ca = between(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = finer;
  }
  Solid s{Points(static_cast<int>(x.size()), 3), Triangles(static_cast<int>(faces.size()), 3)};
  for (std::size_t v = 0; v < x.size(); ++v) s.x.row(static_cast<int>(v)) = x[v].transpose();
  for (std::size_t t = 0; t < faces.size(); ++t)
    s.triangles.row(static_cast<int>(t)) << faces[t][0], faces[t][1], faces[t][2];
  return s;
}

// Star-shaped round the origin: vertices of a ball, each scaled by a factor between `least` and 1.
template <class Random>
Solid star(int times, double least, Random& random) {
  Solid s = ball(times);
  std::uniform_real_distribution<double> factor(least, 1);
  for (int v = 0; v < s.x.rows(); ++v) s.x.row(v) *= factor(random);
  return s;
}

// Rings of `around` vertices, one above the other, joined by quads: ring j is place(j, angle).
template <class Place>
Solid rings(int around, int count, const Place& place) {
  Solid s{Points(around * count, 3), Triangles(2 * around * (count - 1), 3)};
  int t = 0;
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < around; ++i) {
      s.x.row(j * around + i) = place(j, 2 * 3.14159265358979323846 * i / around).transpose();
      if (j + 1 == count) continue;
      const int a = j * around + i, b = j * around + (i + 1) % around, c = a + around, d = b + around;
      s.triangles.row(t++) << a, b, c;
      s.triangles.row(t++) << b, d, c;
    }
  return s;
}

}  // namespace selvedge::closed

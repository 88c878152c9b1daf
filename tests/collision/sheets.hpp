#pragma once

#include <cmath>
#include <numbers>

#include "collision/geometry/surface.hpp"

namespace selvedge::testing {

struct Sheet {
  Points x;
  Triangles triangles;
  Surface surface() const { return make_surface(static_cast<int>(x.rows()), triangles); }
};

// A square sheet of n x n quads in the plane y = height, centred on the origin, with one diagonal per quad.
inline Sheet sheet(int n, double size, double height) {
  Sheet s{Points((n + 1) * (n + 1), 3), Triangles(2 * n * n, 3)};
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      s.x.row(j * (n + 1) + i) << size * (double(i) / n - 0.5), height, size * (double(j) / n - 0.5);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      s.triangles.row(2 * (j * n + i)) << a, c, b;
      s.triangles.row(2 * (j * n + i) + 1) << b, c, d;
    }
  return s;
}

// A sheet of n x n quads over [-1, 1]^2 bent by `place`, a function of two parameters, which are moved off the lattice
// by up to `jitter` so that nothing coincides.
template <class Place>
Sheet bent(int n, const Vec2& jitter, const Place& place) {
  Sheet s = sheet(n, 2, 0);
  for (int v = 0; v < s.x.rows(); ++v) {
    const double a = s.x(v, 0) + jitter.x() * std::sin(7.0 * v), b = s.x(v, 2) + jitter.y() * std::cos(5.0 * v);
    s.x.row(v) = place(a, b).transpose();
  }
  return s;
}

inline Sheet flat(int n, const Vec2& jitter) {
  return bent(n, jitter, [](double a, double b) { return Vec3(a, 0, b); });
}

// A tube round the x axis, open at both ends: n rings of m vertices with radius r(x, angle) for |x| <= half_length.
template <class Radius>
Sheet round_tube(int n, int m, double turn, const Radius& radius, double half_length = 0.5) {
  Sheet s{Points((n + 1) * m, 3), Triangles(2 * n * m, 3)};
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < m; ++j) {
      const double x = half_length * (2.0 * i / n - 1), angle = 2 * std::numbers::pi * (j + turn) / m;
      const double r = radius(x, angle);
      s.x.row(i * m + j) << x, r * std::cos(angle), r * std::sin(angle);
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int a = i * m + j, b = i * m + (j + 1) % m, c = a + m, d = b + m;
      s.triangles.row(2 * (i * m + j)) << a, b, c;
      s.triangles.row(2 * (i * m + j) + 1) << b, d, c;
    }
  return s;
}

// Joins two meshes; the numbers of b follow those of a.
inline Sheet join(const Sheet& a, const Sheet& b) {
  Sheet s{Points(a.x.rows() + b.x.rows(), 3), Triangles(a.triangles.rows() + b.triangles.rows(), 3)};
  s.x << a.x, b.x;
  s.triangles << a.triangles, (b.triangles.array() + static_cast<int>(a.x.rows())).matrix();
  return s;
}

// Two tubes that overlap for |x - 0.35| < 0.15. The second is inside of the first except for a third of the way round.
// Their contours run from a boundary of one tube to a boundary of the other.
inline Sheet tucked() {
  Sheet second = round_tube(24, 48, 0.37, [](double, double angle) { return 0.312 + 0.02 * std::cos(angle); });
  second.x.col(0).array() += 0.7;
  return join(round_tube(24, 48, 0, [](double, double) { return 0.32; }), second);
}

// A closed block round `centre`, its faces cut in two.
inline Sheet block(const Vec3& centre, double half) {
  Sheet body;
  body.x.resize(8, 3);
  for (int v = 0; v < 8; ++v)
    body.x.row(v) = (centre + half * Vec3(v & 1 ? 1 : -1, v & 2 ? 1 : -1, v & 4 ? 1 : -1)).transpose();
  body.triangles.resize(12, 3);
  body.triangles << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5,
      3, 7, 5;
  return body;
}

}  // namespace selvedge::testing

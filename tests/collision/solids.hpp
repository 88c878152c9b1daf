#pragma once

#include <map>
#include <numbers>

#include "collision/geometry/surface.hpp"

// Closed surfaces for tests, counter-clockwise seen from outside.
namespace selvedge::testing {

struct Solid {
  Surface surface;
  Points x;
};

inline Solid solid_of(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles) {
  Solid made;
  made.x.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) made.x.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  Triangles t(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    t.row(static_cast<Eigen::Index>(i)) << triangles[i][0], triangles[i][1], triangles[i][2];
  made.surface = make_surface(static_cast<int>(points.size()), t);
  return made;
}

// A ball of radius 1 with `rings` x 2 `rings` patches.
inline Solid ball(int rings) {
  const int around = 2 * rings;
  std::vector<Vec3> points{{0, 0, 1}};
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double polar = std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * j / around;
      points.emplace_back(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar));
    }
  points.emplace_back(0, 0, -1);
  const int last = static_cast<int>(points.size()) - 1;
  const auto at = [&](int i, int j) { return i == 0 ? 0 : i == rings ? last : 1 + (i - 1) * around + j % around; };
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      if (i + 1 < rings) triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      if (i > 0) triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return solid_of(points, triangles);
}

// A ball with bumps and without symmetry.
inline Solid blob(int rings) {
  Solid made = ball(rings);
  for (int v = 0; v < made.x.rows(); ++v) {
    const Vec3 p = row(made.x, v);
    made.x.row(v) *= 1 + 0.25 * std::sin(5 * p.x() + 1) * std::cos(4 * p.y()) + 0.1 * std::sin(9 * p.z());
  }
  return made;
}

// A box between the corners lo and hi, with n x n squares per side.
inline Solid block(const Vec3& lo, const Vec3& hi, int n) {
  std::vector<Vec3> points;
  std::map<std::array<int, 3>, int> number;
  std::vector<std::array<int, 3>> triangles;
  const auto at = [&](const std::array<int, 3>& place) {
    const auto [found, is_new] = number.emplace(place, static_cast<int>(points.size()));
    if (is_new)
      points.push_back(lo + Vec3(place[0], place[1], place[2]).cwiseProduct(hi - lo) / static_cast<double>(n));
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int a, int b) {
            std::array<int, 3> place{};
            place[axis] = side;
            place[(axis + 1) % 3] = i + a;
            place[(axis + 2) % 3] = j + b;
            return at(place);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side > 0) {
            triangles.push_back({a, b, c});
            triangles.push_back({a, c, d});
          } else {
            triangles.push_back({a, c, b});
            triangles.push_back({a, d, c});
          }
        }
  return solid_of(points, triangles);
}

// A round rod along z of `count` needles.
inline Solid rod(int count, double radius, double length) {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < count; ++i)
    for (const double z : {0.0, length}) {
      const double turn = 2 * std::numbers::pi * i / count;
      points.emplace_back(radius * std::cos(turn), radius * std::sin(turn), z);
    }
  points.emplace_back(0, 0, 0);
  points.emplace_back(0, 0, length);
  for (int i = 0; i < count; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % count);
    triangles.push_back({a, b, b + 1});
    triangles.push_back({a, b + 1, a + 1});
    triangles.push_back({b, a, 2 * count});
    triangles.push_back({a + 1, b + 1, 2 * count + 1});
  }
  return solid_of(points, triangles);
}

inline Solid both(const Solid& a, const Solid& b) {
  Solid made;
  made.x.resize(a.x.rows() + b.x.rows(), 3);
  made.x << a.x, b.x;
  Triangles t(a.surface.triangles.rows() + b.surface.triangles.rows(), 3);
  t << a.surface.triangles, (b.surface.triangles.array() + a.surface.vertex_count).matrix();
  made.surface = make_surface(static_cast<int>(made.x.rows()), t);
  return made;
}

inline Points rotated(const Points& x, const Mat3& rotation) { return x * rotation.transpose(); }

// The mesh without the triangles whose number is a multiple of `step`.
inline Solid without_some(const Solid& solid, int step) {
  std::vector<int> left;
  for (int t = 0; t < solid.surface.triangles.rows(); ++t)
    if (t % step != 0) left.push_back(t);
  return {make_surface(solid.surface.vertex_count, solid.surface.triangles(left, Eigen::all)), solid.x};
}

}  // namespace selvedge::testing

#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge::testing {

struct Tangle {
  std::string name;
  Surface surface;
  Points x;
};

// n x m squares, vertex (i, j) at place(i / n, j / m); the diagonals alternate.
inline Tangle grid_surface(const std::string& name, int n, int m, const std::function<Vec3(double, double)>& place) {
  Points x((n + 1) * (m + 1), 3);
  Triangles triangles(2 * n * m, 3);
  for (int i = 0, t = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      const int a = i * (m + 1) + j;
      x.row(a) = place(double(i) / n, double(j) / m).transpose();
      if (i == n || j == m) continue;
      if ((i + j) % 2) {
        triangles.row(t++) << a, a + 1, a + m + 1;
        triangles.row(t++) << a + 1, a + m + 2, a + m + 1;
      } else {
        triangles.row(t++) << a, a + 1, a + m + 2;
        triangles.row(t++) << a, a + m + 2, a + m + 1;
      }
    }
  return {name, make_surface(static_cast<int>(x.rows()), triangles), x};
}

inline void shake(Points& x, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> push(-size, size);
  for (double& coordinate : x.reshaped()) coordinate += push(random);
}

// A ring of n x m squares whose ends are joined.
inline Tangle tube(int n, int m, double radius, double height) {
  Tangle t;
  t.name = "tube";
  t.x.resize(n * (m + 1), 3);
  Triangles triangles(2 * n * m, 3);
  for (int i = 0, at = 0; i < n; ++i)
    for (int j = 0; j <= m; ++j) {
      const double angle = 2 * std::numbers::pi * i / n;
      const int a = i * (m + 1) + j, b = (i + 1) % n * (m + 1) + j;
      t.x.row(a) << radius * std::cos(angle), height * j / m, radius * std::sin(angle);
      if (j == m) continue;
      triangles.row(at++) << a, a + 1, b;
      triangles.row(at++) << a + 1, b + 1, b;
    }
  t.surface = make_surface(static_cast<int>(t.x.rows()), triangles);
  return t;
}

// Surfaces that are difficult for searches and for culling: some clean, some not.
inline std::vector<Tangle> tangles(int n) {
  const double pi = std::numbers::pi;
  std::vector<Tangle> all;
  const auto add = [&](Tangle t) { all.push_back(std::move(t)); };
  const auto shaken = [&](Tangle t, const std::string& name, double size, unsigned seed) {
    t.name = name;
    shake(t.x, size, seed);
    all.push_back(std::move(t));
  };
  const Tangle flat = grid_surface("flat", n, n, [](double u, double v) { return Vec3(u, 0, v); });
  const Tangle tilted =
      grid_surface("flat and tilted", n, n, [](double u, double v) { return Vec3(u, 0.3 * u + 0.6 * v, 0.8 * v); });
  add(flat);
  add(tilted);
  shaken(flat, "wavy", 0.3 / n, 1);
  shaken(flat, "crumpled", 0.9 / n, 2);
  shaken(flat, "crushed", 0.3, 3);
  add(grid_surface("folded", n, n,
                   [](double u, double v) { return Vec3(std::min(u, 1 - u), u < 0.5 ? 0 : 0.004, v); }));
  add(grid_surface("folded onto itself", n, n, [](double u, double v) { return Vec3(std::min(u, 1 - u), 0, v); }));
  add(grid_surface("fold through itself", n, n, [](double u, double v) {
    return Vec3(std::min(u, 1 - u) + 0.01 * v, u < 0.5 ? 0 : 0.03 - 0.06 * v, v);
  }));
  // In one plane, a ribbon that winds more than once and lies on its own beginning. All normals are the same, so that
  // only the boundary tells.
  add(grid_surface("flat spiral", 4 * n, 2, [&](double u, double v) {
    const double angle = 2.6 * pi * u, radius = 1 + 0.2 * v - 0.05 * u;
    return Vec3(radius * std::cos(angle), 0, radius * std::sin(angle));
  }));
  add(grid_surface("rising spiral", 4 * n, 3, [&](double u, double v) {
    const double angle = 2.6 * pi * u, radius = 1 + 0.2 * v;
    return Vec3(radius * std::cos(angle), 0.01 * u, radius * std::sin(angle));
  }));
  // Like the spiral, but it comes back through itself at a shallow angle.
  add(grid_surface("shallow spiral", 4 * n, 3, [&](double u, double v) {
    const double angle = 2.6 * pi * u, radius = 1 + 0.2 * v;
    return Vec3(radius * std::cos(angle), 0.02 * std::sin(3 * u) + 0.03 * u * (v - 0.5), radius * std::sin(angle));
  }));
  // Each star of triangles winds twice round its vertex.
  add(grid_surface("double cover", 4 * n, 3,
                   [&](double u, double v) { return Vec3(v * std::cos(4 * pi * u), 0, v * std::sin(4 * pi * u)); }));
  add(grid_surface("sheared", n, n, [](double u, double v) { return Vec3(u + v, 2 * u - v, 0); }));
  add(grid_surface("collapsed to a segment", n, n,
                   [](double u, double v) { return Vec3(u + v, u + v, 0.5 * (u + v)); }));
  add(grid_surface("half collapsed", n, n, [](double u, double v) { return Vec3(std::max(u, 0.5), 0, v); }));
  add(grid_surface("far away", n, n, [](double u, double v) { return Vec3(1e6 + u, 1e6 + 0.1 * std::sin(9 * u), v); }));
  add(tube(4 * n, n, 0.5, 1));
  shaken(tube(4 * n, n, 0.5, 1), "dented tube", 0.04, 4);
  return all;
}

}  // namespace selvedge::testing

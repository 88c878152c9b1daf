#include <cmath>
#include <numbers>
#include <random>

#include "collision/geometry/surface.hpp"
#include "pipeline/shapes/generate.hpp"

namespace selvedge {
namespace {

// Vector from one vertex to another, the shorter one if the first coordinate wraps.
Vec2 across(const Points2& uv, int from, int to, double period) {
  Vec2 d = (uv.row(to) - uv.row(from)).transpose();
  if (period > 0) d.x() -= period * std::round(d.x() / period);
  return d;
}

double twice_area(const Points2& uv, const Triangles& triangles, int t, double period) {
  return cross(across(uv, triangles(t, 0), triangles(t, 1), period),
               across(uv, triangles(t, 0), triangles(t, 2), period));
}

// Numbers in [0, 1) that are the same on every machine, which standard distributions are not.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// Moves a vertex, by less if a triangle round it would lose more than 60 % of its area.
void move_safely(Points2& uv, const Triangles& triangles, const Surface& surface, int v, Eigen::RowVector2d move,
                 double period) {
  const Eigen::RowVector2d start = uv.row(v);
  std::vector<double> least;
  for (const int t : surface.triangles_of(v)) least.push_back(0.4 * twice_area(uv, triangles, t, period));
  for (int attempt = 0; attempt < 4; ++attempt, move *= 0.5) {
    uv.row(v) = start + move;
    bool upright = true;
    std::size_t k = 0;
    for (const int t : surface.triangles_of(v)) upright = upright && twice_area(uv, triangles, t, period) > least[k++];
    if (upright) return;
  }
  uv.row(v) = start;
}

void shake(Points2& uv, const Triangles& triangles, const std::vector<bool>& fixed, double amount, std::uint64_t seed,
           double period) {
  const Surface surface = make_surface(static_cast<int>(uv.rows()), triangles);
  std::mt19937_64 random(seed);
  for (int v = 0; v < uv.rows(); ++v) {
    const double angle = 2 * std::numbers::pi * uniform(random), length = amount * std::sqrt(uniform(random));
    if (!fixed[v]) move_safely(uv, triangles, surface, v, {length * std::cos(angle), length * std::sin(angle)}, period);
  }
}

// Moves every free vertex part of the way to the mean of its neighbours, which opens the smallest angles.
void smooth(Points2& uv, const Triangles& triangles, const std::vector<bool>& fixed, double part, double period) {
  const Surface surface = make_surface(static_cast<int>(uv.rows()), triangles);
  for (int v = 0; v < uv.rows(); ++v) {
    if (fixed[v]) continue;
    Eigen::RowVector2d sum = Eigen::RowVector2d::Zero();  // each neighbour of an inner vertex counts twice
    for (const int t : surface.triangles_of(v))
      for (int k = 0; k < 3; ++k) sum += across(uv, v, triangles(t, k), period).transpose();
    const double count = 2 * static_cast<double>(surface.triangles_of(v).size());
    move_safely(uv, triangles, surface, v, part / count * sum, period);
  }
}

int opposite(const Triangles& triangles, int t, int a, int b) {
  for (int k = 0; k < 3; ++k)
    if (triangles(t, k) != a && triangles(t, k) != b) return triangles(t, k);
  return -1;
}

double cotangent(const Points2& uv, int at, int a, int b, double period) {
  const Vec2 u = across(uv, at, a, period), v = across(uv, at, b, period);
  return u.dot(v) / std::abs(cross(u, v));
}

// One sweep over the edges; a triangle takes part in at most one flip. Returns the number of flips.
int flip_sweep(const Points2& uv, Triangles& triangles, double period) {
  const Surface surface = make_surface(static_cast<int>(uv.rows()), triangles);
  std::vector<bool> done(static_cast<std::size_t>(triangles.rows()), false);
  int flips = 0;
  for (int e = 0; e < surface.edges.rows(); ++e) {
    const auto [s, t] = surface.edge_triangles[e];
    if (t < 0 || done[s] || done[t]) continue;
    int a = surface.edges(e, 0), b = surface.edges(e, 1);
    const int c = opposite(triangles, s, a, b), d = opposite(triangles, t, a, b);
    // The edge is Delaunay if the angles that face it sum to at most pi.
    if (cotangent(uv, c, a, b, period) + cotangent(uv, d, a, b, period) > -1e-9) continue;
    if (cross(across(uv, a, b, period), across(uv, a, c, period)) < 0) std::swap(a, b);
    triangles.row(s) << a, d, c;
    triangles.row(t) << d, b, c;
    done[s] = done[t] = true;
    ++flips;
  }
  return flips;
}

}  // namespace

void make_delaunay(const Points2& uv, Triangles& triangles, double period) {
  while (flip_sweep(uv, triangles, period) > 0) {
  }
}

void make_unstructured(Points2& uv, Triangles& triangles, const std::vector<bool>& fixed, double amount,
                       std::uint64_t seed, double period) {
  shake(uv, triangles, fixed, amount, seed, period);
  make_delaunay(uv, triangles, period);
  smooth(uv, triangles, fixed, 0.4, period);
  make_delaunay(uv, triangles, period);
}

}  // namespace selvedge

#include "pipeline/measures/published_measures.hpp"

#include <cassert>
#include <cmath>

#include "collision/geometry/cell_grid.hpp"

namespace selvedge {
namespace {

// For each point the index of the nearest of `others`, the lowest on a tie. All must be finite.
std::vector<int> nearest_of(const Points& others, const Points& points) {
  constexpr double cell = 0.02;  // [m]
  const CellGrid grid(others, cell);
  std::vector<int> nearest(static_cast<std::size_t>(points.rows()), 0);
  for (int v = 0; v < points.rows(); ++v) {
    const Vec3 at = row(points, v);
    double least = HUGE_VAL;
    for (double radius = cell; least > radius * radius; radius *= 2)
      grid.for_each_near(at, radius, [&](int p) {
        const double squared = (row(others, p) - at).squaredNorm();
        int& found = nearest[static_cast<std::size_t>(v)];
        if (squared < least || (squared == least && p < found)) {
          least = squared;
          found = p;
        }
      });
  }
  return nearest;
}

}  // namespace

double l2_mm(const Points& x, const Points& reference) {
  assert(x.rows() == reference.rows());
  return x.rows() == 0 ? 0 : 1000 * (x - reference).rowwise().norm().mean();
}

double e3d(const Points& x, const Points& reference) {
  assert(x.rows() == reference.rows());
  return (x - reference).norm() / reference.norm();
}

double collision_percent(const Surface& body, const Points& body_x, const Points& x) {
  if (body_x.rows() == 0 || x.rows() == 0) return 0;
  const Points normals = vertex_normals(body, body_x);
  const std::vector<int> nearest = nearest_of(body_x, x);
  int behind = 0;
  for (int v = 0; v < x.rows(); ++v) {
    const int p = nearest[static_cast<std::size_t>(v)];
    if ((row(x, v) - row(body_x, p)).dot(row(normals, p)) < 0) ++behind;
  }
  return 100.0 * behind / static_cast<double>(x.rows());
}

double static_share(const Points& before, const Points& x) {
  constexpr double moved = 3e-4;  // [m]
  if (x.rows() == 0) return 100;
  return 100.0 * static_cast<double>(((x - before).rowwise().norm().array() <= moved).count()) /
         static_cast<double>(x.rows());
}

}  // namespace selvedge

#include "collision/exact/inside.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/exact/orientation.hpp"
#include "collision/geometry/closed_shells.hpp"
#include "collision/geometry/stop_scope.hpp"

namespace selvedge {
namespace {

// Triangles by the cells of a grid in the plane perpendicular to the rays.
struct Grid {
  int axis = 0;  // of the rays
  Vec3 lo, hi;
  int cells = 1;  // along each side
  Vec2 per_length;
  std::vector<int> begin, triangles;  // of closed shells; those over cell c are triangles[begin[c] .. begin[c + 1])

  Vec2 flat(const Vec3& p) const { return {p[(axis + 1) % 3], p[(axis + 2) % 3]}; }

  // Monotone in p even when rounded, so that a point over a triangle is in one of the cells of the triangle's box.
  std::array<int, 2> cell(const Vec2& p) const {
    const Vec2 at = (p - flat(lo)).cwiseProduct(per_length);
    return {std::clamp(static_cast<int>(at.x()), 0, cells - 1), std::clamp(static_cast<int>(at.y()), 0, cells - 1)};
  }
};

template <typename Visit>
void for_each_cell(const Grid& grid, const Surface& surface, const Points& x, int triangle, Visit&& visit) {
  const Vec2 a = grid.flat(row(x, surface.triangles(triangle, 0)));
  const Vec2 b = grid.flat(row(x, surface.triangles(triangle, 1)));
  const Vec2 c = grid.flat(row(x, surface.triangles(triangle, 2)));
  const auto first = grid.cell(a.cwiseMin(b).cwiseMin(c)), last = grid.cell(a.cwiseMax(b).cwiseMax(c));
  for (int i = first[0]; i <= last[0]; ++i)
    for (int j = first[1]; j <= last[1]; ++j) visit(i * grid.cells + j);
}

// A grid of the triangles of closed shells. At least one shell must be closed.
Grid make_grid(const Surface& surface, const Points& x, const std::vector<char>& closed) {
  Grid grid;
  grid.lo.setConstant(std::numeric_limits<double>::infinity());
  grid.hi = -grid.lo;
  const auto counts = [&](int t) { return closed[surface.component[surface.triangles(t, 0)]] != 0; };
  for (int index : surface.triangles.reshaped()) {
    if (!closed[surface.component[index]]) continue;
    grid.lo = grid.lo.cwiseMin(row(x, index));
    grid.hi = grid.hi.cwiseMax(row(x, index));
  }
  // Along the shortest side a ray meets the fewest triangles.
  (grid.hi - grid.lo).minCoeff(&grid.axis);
  const int count = static_cast<int>(surface.triangles.rows());
  grid.cells = std::max(1, static_cast<int>(std::sqrt(count)));
  const Vec2 size = grid.flat(grid.hi - grid.lo);
  for (int k = 0; k < 2; ++k) grid.per_length[k] = size[k] > 0 ? grid.cells / size[k] : 0;

  grid.begin.assign(grid.cells * grid.cells + 1, 0);
  for (int t = 0; t < count; ++t)
    if (counts(t)) for_each_cell(grid, surface, x, t, [&](int cell) { ++grid.begin[cell + 1]; });
  for (int c = 0; c < grid.cells * grid.cells; ++c) grid.begin[c + 1] += grid.begin[c];
  grid.triangles.resize(grid.begin.back());
  std::vector<int> next(grid.begin.begin(), grid.begin.end() - 1);
  for (int t = 0; t < count; ++t)
    if (counts(t)) for_each_cell(grid, surface, x, t, [&](int cell) { grid.triangles[next[cell]++] = t; });
  return grid;
}

// Orientation of a, b and p moved by (e, e^2) for an infinitesimal e > 0: zero only where a and b coincide.
int moved_orientation(const Vec2& a, const Vec2& b, const Vec2& p) {
  if (const int sign = orient2d(a, b, p)) return sign;
  if (a.y() != b.y()) return a.y() > b.y() ? 1 : -1;
  if (a.x() != b.x()) return b.x() > a.x() ? 1 : -1;
  return 0;
}

// Is p on the closed triangle, which may be degenerate? It is if it is in the plane and, seen along each axis, beyond
// no edge. In a view that shows the triangle as a line or a point, its box decides.
bool on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  if ((p.array() < a.array().min(b.array()).min(c.array())).any() ||
      (p.array() > a.array().max(b.array()).max(c.array())).any() || orient3d(a, b, c, p) != 0)
    return false;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [least, most] = std::minmax({orient2d(a, b, p, axis), orient2d(b, c, p, axis), orient2d(c, a, p, axis)});
    if (least < 0 && most > 0) return false;
  }
  return true;
}

int winding_number(const Grid& grid, const Surface& surface, const Points& x, const Vec3& p) {
  if (!((p.array() >= grid.lo.array()).all() && (p.array() <= grid.hi.array()).all())) return 0;
  const Vec2 flat = grid.flat(p);
  const auto [i, j] = grid.cell(flat);
  const int cell = i * grid.cells + j;
  int winding = 0;
  for (int at = grid.begin[cell]; at < grid.begin[cell + 1]; ++at) {
    const int t = grid.triangles[at];
    const Vec3 a = row(x, surface.triangles(t, 0)), b = row(x, surface.triangles(t, 1));
    const Vec3 c = row(x, surface.triangles(t, 2));
    if (on_triangle(p, a, b, c)) return 0;
    const Vec2 a2 = grid.flat(a), b2 = grid.flat(b), c2 = grid.flat(c);
    const int seen = moved_orientation(a2, b2, flat);
    if (seen == 0 || moved_orientation(b2, c2, flat) != seen || moved_orientation(c2, a2, flat) != seen) continue;
    if (orient3d(a, b, c, p) != seen) winding += seen;  // p is in front of the triangle, seen along the ray
  }
  return winding;
}

}  // namespace

std::vector<int> winding_numbers(const Surface& surface, const Points& x, const Points& points) {
  std::vector<int> result(points.rows(), 0);
  const std::vector<char> closed = closed_shells(surface);
  if (std::ranges::find(closed, 1) == closed.end()) return result;
  const Grid grid = make_grid(surface, x, closed);
  const int count = static_cast<int>(points.rows());
  StopPoll stop;
#pragma omp parallel for schedule(dynamic, 256)
  for (int i = 0; i < count; ++i)
    if (!stop.wanted()) result[i] = winding_number(grid, surface, x, row(points, i));
  stop.check();
  return result;
}

std::vector<char> inside(const Surface& surface, const Points& x, const Points& points) {
  const std::vector<int> winding = winding_numbers(surface, x, points);
  std::vector<char> result(winding.size());
  std::ranges::transform(winding, result.begin(), [](int number) { return number != 0; });
  return result;
}

}  // namespace selvedge

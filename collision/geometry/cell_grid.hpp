#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "collision/geometry/lists.hpp"
#include "collision/geometry/points.hpp"

namespace selvedge {

// Points sorted by the cubes of a grid.
class CellGrid {
 public:
  // All points must be finite; `cell` is the cubes' edge [m]. It is doubled until the points' bounding box has at most
  // `most_cubes` cubes.
  CellGrid(const Points& x, double cell);
  static constexpr int most_cubes = 1 << 24;

  double edge() const { return cell_; }   // of a cube [m]
  double distance(const Vec3& at) const;  // of `at` from all cubes together [m]; 0 inside

  // The points, sorted by the cubes in which they lie.
  const std::vector<int>& order() const { return points_.item; }

  // The number of cubes, and the place in `order` where a cube's points begin. first(cubes()) is the end of `order`.
  int cubes() const { return static_cast<int>(points_.begin.size()) - 1; }
  int first(int cube) const { return points_.begin[cube]; }

  // Visits the points of all cubes that the ball's box meets, the ball's own among them, in a fixed order.
  template <class Visit>
  void for_each_near(const Vec3& at, double radius, Visit visit) const {
    for_each_place_near(at, radius, [&](int p) { visit(points_.item[p]); });
  }

  // The same, but visits the points' places in `order`, ascending.
  template <class Visit>
  void for_each_place_near(const Vec3& at, double radius, Visit visit) const {
    for_each_place_in((at.array() - radius).matrix(), (at.array() + radius).matrix(), visit);
  }

  // The same for the cubes that the box from `lo` to `hi` meets.
  template <class Visit>
  void for_each_place_in(const Vec3& lo, const Vec3& hi, Visit visit) const {
    std::array<int, 3> from, to;
    for (int k = 0; k < 3; ++k) {
      from[k] = std::max(0, coordinate(lo[k], k));
      to[k] = std::min(size_[k] - 1, coordinate(hi[k], k));
    }
    if (from[2] > to[2]) return;
    for (int i = from[0]; i <= to[0]; ++i)
      for (int j = from[1]; j <= to[1]; ++j)
        for (int p = first(cell(i, j, from[2])); p < first(cell(i, j, to[2]) + 1); ++p) visit(p);
  }

  // Visits the cubes within `rings` of a cube along each axis, with the cube itself, in ascending order: the first and
  // the last cube of each row.
  template <class Visit>
  void for_each_row_around(int cube, int rings, Visit visit) const {
    const std::array<int, 3> at{cube / size_[2] / size_[1], cube / size_[2] % size_[1], cube % size_[2]};
    std::array<int, 3> from, to;
    for (int k = 0; k < 3; ++k) {
      from[k] = std::max(0, at[k] - rings);
      to[k] = std::min(size_[k] - 1, at[k] + rings);
    }
    for (int i = from[0]; i <= to[0]; ++i)
      for (int j = from[1]; j <= to[1]; ++j) visit(cell(i, j, from[2]), cell(i, j, to[2]));
  }

 private:
  int coordinate(double at, int axis) const;
  int cell(int i, int j, int k) const { return (i * size_[1] + j) * size_[2] + k; }

  Vec3 lo_ = Vec3::Zero();
  double cell_;
  std::array<int, 3> size_{1, 1, 1};
  IndexLists points_;  // of each cell
};

}  // namespace selvedge

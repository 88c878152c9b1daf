#include "collision/geometry/cell_grid.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/lists.hpp"

namespace selvedge {

namespace {

double cube_count(const Vec3& extent, double cell) {
  double count = 1;
  for (int k = 0; k < 3; ++k) count *= std::floor(extent[k] / cell) + 1;
  return count;
}

}  // namespace

CellGrid::CellGrid(const Points& x, double cell_edge) : cell_(cell_edge) {
  if (x.rows() > 0) {
    lo_ = x.colwise().minCoeff().transpose();
    const Vec3 hi = x.colwise().maxCoeff().transpose();
    while (cube_count(hi - lo_, cell_) > most_cubes) cell_ *= 2;
    for (int k = 0; k < 3; ++k) size_[k] = coordinate(hi[k], k) + 1;
  }
  std::vector<int> cells(static_cast<std::size_t>(x.rows()));
  for (int v = 0; v < x.rows(); ++v)
    cells[v] = cell(coordinate(x(v, 0), 0), coordinate(x(v, 1), 1), coordinate(x(v, 2), 2));
  points_ = indices_by_value(cells, cell(size_[0] - 1, size_[1] - 1, size_[2] - 1) + 1);
}

double CellGrid::distance(const Vec3& at) const {
  const Vec3 hi = lo_ + cell_ * Vec3(size_[0], size_[1], size_[2]);
  return (lo_ - at).cwiseMax(at - hi).cwiseMax(0.0).norm();
}

int CellGrid::coordinate(double at, int axis) const {
  return static_cast<int>(std::clamp(std::floor((at - lo_[axis]) / cell_), -1e9, 1e9));
}

}  // namespace selvedge

#include "collision/geometry/cell_grid.hpp"

#include <cmath>

namespace selvedge {

CellGrid::CellGrid(const Points& x, double cell_edge) : cell_(cell_edge) {
  if (x.rows() > 0) {
    lo_ = x.colwise().minCoeff().transpose();
    for (int k = 0; k < 3; ++k) size_[k] = coordinate(x.col(k).maxCoeff(), k) + 1;
  }
  std::vector<int> cells(static_cast<std::size_t>(x.rows()));
  begin_.assign(static_cast<std::size_t>(cell(size_[0] - 1, size_[1] - 1, size_[2] - 1)) + 2, 0);
  for (int v = 0; v < x.rows(); ++v) {
    cells[v] = cell(coordinate(x(v, 0), 0), coordinate(x(v, 1), 1), coordinate(x(v, 2), 2));
    ++begin_[cells[v] + 1];
  }
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  point_.resize(cells.size());
  for (int v = 0; v < x.rows(); ++v) point_[next[cells[v]]++] = v;
}

int CellGrid::coordinate(double at, int axis) const { return static_cast<int>(std::floor((at - lo_[axis]) / cell_)); }

}  // namespace selvedge

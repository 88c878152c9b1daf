#include "learned/repulsion/layer_order.hpp"

#include <algorithm>

#include "collision/geometry/cell_grid.hpp"

namespace selvedge {

std::vector<double> ordered_heights(const std::vector<SignedDistance>& at, double margin, const LayerOrder& order) {
  std::vector<double> heights, depths;
  for (const SignedDistance& d : at) {
    heights.push_back(d.value < 0 ? margin : d.value);
    if (d.value < 0) depths.push_back(std::min(-d.value, order.most));
  }
  if (depths.empty()) return heights;
  Points places(std::ssize(depths), 3);
  Eigen::Index next = 0;
  for (const SignedDistance& d : at)
    if (d.value < 0) places.row(next++) = d.closest.transpose();
  const CellGrid grid(places, order.span);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double height = at[i].value;
    if (height >= order.reach) continue;
    double depth = 0;  // of the deepest vertex over this place
    grid.for_each_near(at[i].closest, order.span, [&](int k) {
      const double part = 1 - (row(places, k) - at[i].closest).norm() / order.span;
      depth = std::max(depth, part * depths[static_cast<std::size_t>(k)]);
    });
    if (depth <= 0) continue;
    const double squeezed = (order.reach - margin) / (order.reach + depth);
    heights[i] = std::max(heights[i], margin + squeezed * (height + depth));
  }
  return heights;
}

}  // namespace selvedge

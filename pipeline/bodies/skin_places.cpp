#include "pipeline/bodies/skin_places.hpp"

#include "collision/geometry/same_places.hpp"

namespace selvedge {
namespace {

constexpr double same_weight = 1e-6;  // also of directions [m]: vertices that differ by less move alike

}  // namespace

std::vector<int> same_places(const SkinnedSurface& skin) {
  std::vector<int> places = same_places(skin.rest);
  const auto same_rows = [](const Eigen::MatrixXd& directions, int v, int w) {
    return directions.cols() == 0 ||
           (directions.middleRows(3 * v, 3) - directions.middleRows(3 * w, 3)).cwiseAbs().maxCoeff() <= same_weight;
  };
  const auto moves_alike = [&](int v, int w) {
    if (v == w) return true;
    const Eigen::RowVectorXd weights = skin.weights.row(v), others = skin.weights.row(w);
    return (weights - others).cwiseAbs().maxCoeff() <= same_weight && same_rows(skin.shape_directions, v, w) &&
           same_rows(skin.pose_directions, v, w);
  };
  part_places(moves_alike, places);
  return places;
}

}  // namespace selvedge

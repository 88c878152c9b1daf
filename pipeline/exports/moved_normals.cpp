#include "pipeline/exports/moved_normals.hpp"

#include <map>

namespace selvedge {

NormalSlots normal_slots(const Look& look) {
  NormalSlots slots;
  std::map<std::pair<int, int>, int> known;
  for (std::size_t k = 0; k < look.corner_normal.size(); ++k) {
    const int vertex = look.vertex[static_cast<std::size_t>(look.corners[k])];
    const auto [slot, fresh] = known.emplace(std::pair(vertex, look.corner_normal[k]), slots.count);
    slots.count += fresh;
    slots.of_corner.push_back(slot->second);
  }
  return slots;
}

PointsF moved_normals(const Look& look, const NormalSlots& slots, const PointsF& x) {
  Points sums = Points::Zero(slots.count, 3);
  const auto at = [&](int corner) -> Vec3 {
    return x.row(look.corners[static_cast<std::size_t>(corner)]).cast<double>().transpose();
  };
  for (int face = 0; face < look.faces(); ++face) {
    const int begin = look.begin_of(face), end = look.end_of(face);
    Vec3 twice_area = Vec3::Zero();
    for (int k = begin + 1; k + 1 < end; ++k) twice_area += (at(k) - at(begin)).cross(at(k + 1) - at(begin));
    for (int k = begin; k < end; ++k) sums.row(slots.of_corner[static_cast<std::size_t>(k)]) += twice_area.transpose();
  }
  for (Eigen::Index s = 0; s < sums.rows(); ++s) {
    const double length = sums.row(s).norm();
    sums.row(s) = length > 0 ? (sums.row(s) / length).eval() : Eigen::RowVector3d(0, 1, 0);
  }
  return sums.cast<float>();
}

}  // namespace selvedge

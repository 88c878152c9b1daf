#include "collision/contact/pair_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace selvedge {
namespace {

int first_of_second(const NodePair& pair) { return pair.kind == PairKind::vertex_face ? 1 : 2; }

// Squared distance of the boxes round the pair's primitives [m^2].
double squared_box_gap(const NodePair& pair, const Points& x) {
  const int split = first_of_second(pair);
  const auto bounds = [&](int first, int last, Vec3& lo, Vec3& hi) {
    lo = hi = row(x, pair.nodes[first]);
    for (int i = first + 1; i < last; ++i) {
      lo = lo.cwiseMin(row(x, pair.nodes[i]));
      hi = hi.cwiseMax(row(x, pair.nodes[i]));
    }
  };
  Vec3 lo_a, hi_a, lo_b, hi_b;
  bounds(0, split, lo_a, hi_a);
  bounds(split, 4, lo_b, hi_b);
  return (lo_a - hi_b).cwiseMax(lo_b - hi_a).cwiseMax(0).squaredNorm();
}

}  // namespace

PairMotion::PairMotion(const Points& at, const Points& x0, const Points& x1)
    : from_(x0 == at ? Points() : Points(x0 - at)),
      to_(x1 - at),
      rounding_(64 * std::numeric_limits<double>::epsilon() *
                std::max({largest_coordinate(at), largest_coordinate(x0), largest_coordinate(x1)})) {}

bool PairMotion::may_come_within(const NodePair& pair, double gap, double distance) const {
  const double room = gap - distance - rounding_;
  if (!(room > 0)) return true;
  const int split = first_of_second(pair);
  const auto stays = [&](const Points& moved) {
    double most = 0;
    for (int a = 0; a < split; ++a)
      for (int b = split; b < 4; ++b)
        most = std::max(most, (moved.row(pair.nodes[a]) - moved.row(pair.nodes[b])).squaredNorm());
    return most < room * room;
  };
  return !stays(to_) || (from_.rows() > 0 && !stays(from_));
}

std::optional<double> gap_if_near(const PairMotion& motion, const NodePair& pair, const Points& x0, double distance) {
  double gap = std::sqrt(squared_box_gap(pair, x0));
  if (!motion.may_come_within(pair, gap, distance)) return std::nullopt;
  gap = std::sqrt(closest(pair, x0).squared_distance);
  if (!motion.may_come_within(pair, gap, distance)) return std::nullopt;
  return gap;
}

}  // namespace selvedge

#include "collision/path_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/distance.hpp"

namespace selvedge {
namespace {

// In thicknesses: what a list is good for beyond its motion. Where things move fast the next motion ends elsewhere, and
// the list is made anew anyhow.
constexpr double usual_slack = 0.5, fast_slack = 0.1, fast_way = 4;

double largest(const Points& x) { return x.rows() > 0 ? x.cwiseAbs().maxCoeff() : 0.0; }

void measure_gaps(PathPairs& path) {
  path.gap.resize(path.pairs.size());
  const int count = static_cast<int>(path.pairs.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < count; ++i) path.gap[i] = std::sqrt(closest(path.pairs[i], path.start).squared_distance);
}

}  // namespace

bool update_pairs(PairSearch& search, double thickness, const Points& x0, const Points& x1, PathPairs& path) {
  const auto near_end = [&](const Points& x) {
    return (x - path.end).rowwise().squaredNorm().maxCoeff() <= path.slack * path.slack;
  };
  if (path.end.rows() == x1.rows() && near_end(x1) && (path.start == x0 || near_end(x0))) return false;
  path.start = x0;
  path.end = x1;
  const bool fast = (x1 - x0).rowwise().squaredNorm().maxCoeff() > fast_way * fast_way * thickness * thickness;
  path.slack = (fast ? fast_slack : usual_slack) * thickness;
  search.find(x0, x1, thickness + 2 * path.slack, path.pairs);
  measure_gaps(path);
  return true;
}

PathMotion::PathMotion(const PathPairs& path, const Points& x0, const Points& x1)
    : path_(path),
      from_(x0 - path.start),
      to_(x1 - path.start),
      rounding_(64 * std::numeric_limits<double>::epsilon() *
                std::max({largest(path.start), largest(x0), largest(x1)})) {}

bool PathMotion::may_come_within(std::size_t i, double distance) const {
  const NodePair& pair = path_.pairs[i];
  const double room = path_.gap[i] - distance - rounding_;
  if (!(room > 0)) return true;
  const int split = pair.kind == PairKind::vertex_face ? 1 : 2;
  double most = 0;
  for (int a = 0; a < split; ++a)
    for (int b = split; b < 4; ++b)
      most = std::max({most, (from_.row(pair.nodes[a]) - from_.row(pair.nodes[b])).squaredNorm(),
                       (to_.row(pair.nodes[a]) - to_.row(pair.nodes[b])).squaredNorm()});
  return !(most < room * room);
}

std::vector<NodePair> pairs_within(const PathPairs& path, const Points& x, double distance) {
  const PathMotion motion(path, x, x);
  std::vector<NodePair> near;
  for (std::size_t i = 0; i < path.pairs.size(); ++i)
    if (motion.may_come_within(i, distance)) near.push_back(path.pairs[i]);
  return near;
}

}  // namespace selvedge

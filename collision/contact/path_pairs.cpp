#include "collision/contact/path_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace selvedge {
namespace {

constexpr double slack_part = 0.5;        // of the thickness
constexpr double few_beyond_slack = 0.3;  // of the cloth's vertices: if fewer stray, only their pairs are searched

// Removes the pairs from `first` on for which out(i) is true.
template <class Out>
void leave_out(PathPairs& path, std::size_t first, Out&& out) {
  std::size_t kept = first;
  for (std::size_t i = first; i < path.pairs.size(); ++i) {
    if (out(i)) continue;
    path.pairs[kept] = path.pairs[i];
    path.gap[kept++] = path.gap[i];
  }
  path.pairs.resize(kept);
  path.gap.resize(kept);
}

// Squared distance of the boxes round the pair's primitives [m^2].
double squared_gap(const NodePair& pair, const Points& x) {
  const int split = pair.kind == PairKind::vertex_face ? 1 : 2;
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

// Marks the list as valid for no motion until it is complete again, since a search may throw.
void invalidate(PathPairs& path) { path.end.resize(0, 3); }

// Of the pairs from `first` on, keeps those that may come within `reach` [m], with their gaps. Boxes of motions overlap
// for many pairs that never come near each other; the gap of the pair's own boxes excludes most of these.
void keep_what_comes_near(PathPairs& path, std::size_t first, double reach) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const PathMotion motion(path, path.start, path.end);
  path.gap.resize(path.pairs.size());
  const int begin = static_cast<int>(first), end = static_cast<int>(path.pairs.size());
#pragma omp parallel for schedule(static)
  for (int i = begin; i < end; ++i) {
    path.gap[i] = std::sqrt(squared_gap(path.pairs[i], path.start));
    if (motion.may_come_within(i, reach)) path.gap[i] = std::sqrt(closest(path.pairs[i], path.start).squared_distance);
    if (!motion.may_come_within(i, reach)) path.gap[i] = never;
  }
  leave_out(path, first, [&](std::size_t i) { return path.gap[i] == never; });
}

// 1 for nodes that end farther than `slack` from path.end.
std::vector<char> nodes_beyond_slack(const PathPairs& path, const Points& x1) {
  std::vector<char> beyond_slack(static_cast<std::size_t>(x1.rows()));
  for (Eigen::Index i = 0; i < x1.rows(); ++i)
    beyond_slack[i] = !((x1.row(i) - path.end.row(i)).squaredNorm() <= path.slack * path.slack);
  return beyond_slack;
}

void search_again(PairSearch& search, const std::vector<char>& beyond_slack, double reach, const Points& x1,
                  PathPairs& path) {
  leave_out(path, 0, [&](std::size_t i) {
    return std::ranges::any_of(path.pairs[i].nodes, [&](int node) { return beyond_slack[node] != 0; });
  });
  Points end = path.end;
  for (Eigen::Index i = 0; i < x1.rows(); ++i)
    if (beyond_slack[i]) end.row(i) = x1.row(i);
  std::vector<NodePair> found;
  invalidate(path);
  search.find(path.start, end, reach, found, beyond_slack);
  path.end = std::move(end);
  const std::size_t kept = path.pairs.size();
  path.pairs.insert(path.pairs.end(), found.begin(), found.end());
  keep_what_comes_near(path, kept, reach);
}

}  // namespace

bool update_pairs(PairSearch& search, double thickness, const Points& x0, const Points& x1, PathPairs& path) {
  const auto near_end = [&](const Points& x) {
    return (x - path.end).rowwise().squaredNorm().maxCoeff() <= path.slack * path.slack;
  };
  const double reach = thickness + 2 * slack_part * thickness;
  if (path.end.rows() == x1.rows()) {
    if (path.start == x0) {
      const std::vector<char> beyond_slack = nodes_beyond_slack(path, x1);
      const auto count = std::ranges::count(beyond_slack, 1);
      if (count == 0) return false;
      if (static_cast<double>(count) < few_beyond_slack * search.world().cloth->vertex_count) {
        search_again(search, beyond_slack, reach, x1, path);
        return false;
      }
    } else if (near_end(x1) && near_end(x0)) {
      return false;
    }
  }
  invalidate(path);
  search.find(x0, x1, reach, path.pairs, path.marks);
  path.start = x0;
  path.end = x1;
  path.slack = slack_part * thickness;
  keep_what_comes_near(path, 0, reach);
  return true;
}

PathMotion::PathMotion(const PathPairs& path, const Points& x0, const Points& x1)
    : path_(path),
      from_(x0 == path.start ? Points() : Points(x0 - path.start)),
      to_(x1 - path.start),
      rounding_(64 * std::numeric_limits<double>::epsilon() *
                std::max({largest_coordinate(path.start), largest_coordinate(x0), largest_coordinate(x1)})) {}

bool PathMotion::may_come_within(std::size_t i, double distance) const {
  const NodePair& pair = path_.pairs[i];
  const double room = path_.gap[i] - distance - rounding_;
  if (!(room > 0)) return true;
  const int split = pair.kind == PairKind::vertex_face ? 1 : 2;
  const auto stays = [&](const Points& moved) {
    double most = 0;
    for (int a = 0; a < split; ++a)
      for (int b = split; b < 4; ++b)
        most = std::max(most, (moved.row(pair.nodes[a]) - moved.row(pair.nodes[b])).squaredNorm());
    return most < room * room;
  };
  return !stays(to_) || (from_.rows() > 0 && !stays(from_));
}

std::vector<NodePair> pairs_within(const PathPairs& path, const Points& x, double distance) {
  const PathMotion motion(path, x, x);
  std::vector<NodePair> near;
  for (std::size_t i = 0; i < path.pairs.size(); ++i)
    if (motion.may_come_within(i, distance)) near.push_back(path.pairs[i]);
  return near;
}

}  // namespace selvedge

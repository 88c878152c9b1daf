#include "collision/contact/path_pairs.hpp"

#include <algorithm>
#include <utility>

#include "collision/contact/pair_motion.hpp"

namespace selvedge {
namespace {

constexpr double slack_part = 0.5;        // of the thickness
constexpr double few_beyond_slack = 0.3;  // of the cloth's vertices: if fewer stray, only their pairs are searched

// Marks the list as valid for no motion until it is complete again, since a search may throw.
void invalidate(PathPairs& path) { path.end.resize(0, 3); }

// 1 for nodes that end farther than `slack` from path.end.
std::vector<char> nodes_beyond_slack(const PathPairs& path, const Points& x1) {
  std::vector<char> beyond_slack(static_cast<std::size_t>(x1.rows()));
  for (Eigen::Index i = 0; i < x1.rows(); ++i)
    beyond_slack[i] = !((x1.row(i) - path.end.row(i)).squaredNorm() <= path.slack * path.slack);
  return beyond_slack;
}

void leave_out_pairs_of(const std::vector<char>& nodes, PathPairs& path) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < path.pairs.size(); ++i) {
    if (std::ranges::any_of(path.pairs[i].nodes, [&](int node) { return nodes[node] != 0; })) continue;
    path.pairs[kept] = path.pairs[i];
    path.gap[kept++] = path.gap[i];
  }
  path.pairs.resize(kept);
  path.gap.resize(kept);
}

void search_again(PairSearch& search, const std::vector<char>& beyond_slack, double reach, const Points& x1,
                  PathPairs& path) {
  leave_out_pairs_of(beyond_slack, path);
  Points end = path.end;
  for (Eigen::Index i = 0; i < x1.rows(); ++i)
    if (beyond_slack[i]) end.row(i) = x1.row(i);
  std::vector<NodePair> found;
  std::vector<double> gap;
  invalidate(path);
  search.find_near(path.start, end, reach, found, gap, beyond_slack);
  path.end = std::move(end);
  path.pairs.insert(path.pairs.end(), found.begin(), found.end());
  path.gap.insert(path.gap.end(), gap.begin(), gap.end());
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
  search.find_near(x0, x1, reach, path.pairs, path.gap, path.marks);
  path.start = x0;
  path.end = x1;
  path.slack = slack_part * thickness;
  return true;
}

std::vector<NodePair> pairs_within(const PathPairs& path, const Points& x, double distance) {
  const PairMotion motion(path.start, x, x);
  std::vector<NodePair> near;
  for (std::size_t i = 0; i < path.pairs.size(); ++i)
    if (motion.may_come_within(path.pairs[i], path.gap[i], distance)) near.push_back(path.pairs[i]);
  return near;
}

}  // namespace selvedge

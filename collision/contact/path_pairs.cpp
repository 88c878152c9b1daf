#include "collision/contact/path_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace selvedge {
namespace {

constexpr double slack_part = 0.5;      // of the thickness
constexpr double few_are_astray = 0.3;  // of the cloth's vertices: if fewer are, only their pairs are searched for

// Marks the list as valid for no motion until it is complete again, since a search may throw.
void invalidate(PathPairs& path) { path.end.resize(0, 3); }

// Nodes that end too far from where they were for the list, of one kind of pairs.
struct Astray {
  std::vector<char> nodes;
  std::ptrdiff_t count = 0;

  void add(int node, const Points& x, const Points& end, double most) {
    if ((x.row(node) - end.row(node)).squaredNorm() <= most * most) return;
    nodes[node] = 1;
    ++count;
  }
};

// `slack`: half of how far the nodes of a pair may stray in sum [m].
Astray astray_from_cloth(const ContactWorld& world, const PathPairs& path, double slack, const Points& x) {
  Astray astray{std::vector<char>(static_cast<std::size_t>(x.rows()))};
  if (!world.self) return astray;
  for (int v = 0; v < path.cloth_end.rows(); ++v) astray.add(v, x, path.cloth_end, slack);
  return astray;
}

// Obstacles mostly end as they did. What they do not take of twice the slack is left to the cloth.
Astray astray_from_obstacles(const PathPairs& path, double slack, const Points& x) {
  Astray astray{std::vector<char>(static_cast<std::size_t>(x.rows()))};
  const int cloth = static_cast<int>(path.cloth_end.rows()), nodes = static_cast<int>(x.rows()),
            obstacles = nodes - cloth;
  if (obstacles == 0) return astray;
  const double farthest = (x.bottomRows(obstacles) - path.end.bottomRows(obstacles)).rowwise().squaredNorm().maxCoeff();
  const double taken = farthest <= slack * slack ? std::sqrt(farthest) : slack;
  for (int v = 0; v < cloth; ++v) astray.add(v, x, path.end, 2 * slack - taken);
  for (int node = cloth; node < nodes; ++node) astray.add(node, x, path.end, slack);
  return astray;
}

// Pairs of the cloth with itself, or else pairs with an obstacle.
bool is_among(const NodePair& pair, Among among, int cloth_vertices) {
  const bool of_cloth = std::ranges::all_of(pair.nodes, [&](int node) { return node < cloth_vertices; });
  return of_cloth == (among == Among::cloth);
}

// Takes the pairs of one kind off the list: all, or those with an astray node.
void leave_out(Among among, const std::vector<char>& astray, PathPairs& path) {
  const int cloth = static_cast<int>(path.cloth_end.rows());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < path.pairs.size(); ++i) {
    const NodePair& pair = path.pairs[i];
    if ((astray.empty() || std::ranges::any_of(pair.nodes, [&](int node) { return astray[node] != 0; })) &&
        is_among(pair, among, cloth))
      continue;
    path.pairs[kept] = pair;
    path.gap[kept++] = path.gap[i];
  }
  path.pairs.resize(kept);
  path.gap.resize(kept);
}

// Lists the pairs of one kind for ends at x1: of the astray nodes if they are few, else of all. True if of all.
bool search_again(PairSearch& search, Among among, const Astray& astray, const Points& x1, PathPairs& path) {
  if (astray.count == 0) return false;
  const bool few = static_cast<double>(astray.count) < few_are_astray * search.world().cloth->vertex_count;
  leave_out(among, few ? astray.nodes : std::vector<char>{}, path);
  Points end = x1;
  if (few) {
    end = path.end;
    if (among == Among::cloth) end.topRows(path.cloth_end.rows()) = path.cloth_end;
    for (Eigen::Index i = 0; i < x1.rows(); ++i)
      if (astray.nodes[i]) end.row(i) = x1.row(i);
  }
  std::vector<NodePair> found;
  std::vector<double> gap;
  search.find_near(path.start, end, path.reach, found, gap, few ? astray.nodes : path.marks, among);
  if (among == Among::cloth)
    path.cloth_end = end.topRows(path.cloth_end.rows());
  else
    path.end = std::move(end);
  path.pairs.insert(path.pairs.end(), found.begin(), found.end());
  path.gap.insert(path.gap.end(), gap.begin(), gap.end());
  return !few;
}

}  // namespace

bool update_pairs(PairSearch& search, double thickness, const Points& x0, const Points& x1, PathPairs& path) {
  const ContactWorld& world = search.world();
  if (path.end.rows() == x1.rows() && path.reach >= thickness) {
    const double slack = 0.5 * (path.reach - thickness);
    const Astray of_cloth = astray_from_cloth(world, path, slack, x1),
                 of_obstacles = astray_from_obstacles(path, slack, x1);
    if (path.start == x0) {
      try {
        const bool all_of_cloth = search_again(search, Among::cloth, of_cloth, x1, path);
        const bool all_of_obstacles = search_again(search, Among::obstacles, of_obstacles, x1, path);
        return all_of_cloth || all_of_obstacles;
      } catch (...) {
        invalidate(path);
        throw;
      }
    }
    if (of_cloth.count + of_obstacles.count == 0 &&
        astray_from_cloth(world, path, slack, x0).count + astray_from_obstacles(path, slack, x0).count == 0)
      return false;
  }
  invalidate(path);
  path.reach = thickness + 2 * slack_part * thickness;
  search.find_near(x0, x1, path.reach, path.pairs, path.gap, path.marks);
  path.start = x0;
  path.end = x1;
  path.cloth_end = x1.topRows(world.cloth->vertex_count);
  return true;
}

TouchTest::TouchTest(const PathPairs& path, double reach, const Points& x0, const Points& x1)
    : path_(path), reach_(reach), x0_(x0), x1_(x1), motion_(path.start, x0, x1) {}

bool TouchTest::operator()(std::size_t listed) const {
  const NodePair& pair = path_.pairs[listed];
  const auto is_near = [&](const Points& x) { return closest(pair, x).squared_distance < reach_ * reach_; };
  return motion_.may_come_within(pair, path_.gap[listed], reach_) && (is_near(x0_) || is_near(x1_));
}

std::vector<NodePair> pairs_within(const PathPairs& path, const Points& x, double distance) {
  const PairMotion motion(path.start, x, x);
  std::vector<NodePair> near;
  for (std::size_t i = 0; i < path.pairs.size(); ++i)
    if (motion.may_come_within(path.pairs[i], path.gap[i], distance)) near.push_back(path.pairs[i]);
  return near;
}

}  // namespace selvedge

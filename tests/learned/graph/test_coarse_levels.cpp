#include <catch2/catch.hpp>

#include <random>

#include "collision/geometry/adjacency.hpp"
#include "learned/graph/coarse_levels.hpp"
#include "learned/graph/graph_centre.hpp"
#include "tests/learned/graph_scenes.hpp"
#include "tests/learned/parity_pack.hpp"

namespace selvedge::test_coarse_levels {

namespace {

using PairList = std::vector<std::pair<int, int>>;

PairList pairs_of(const Edges& edges) {
  PairList pairs;
  for (const auto& edge : edges.rowwise()) pairs.emplace_back(edge[0], edge[1]);
  return pairs;
}

PairList their_level(const Npz& npz, const std::string& name) {
  const std::vector<int> flat = parity::integers(npz, name);
  PairList pairs;
  for (std::size_t i = 0; i < flat.size(); i += 2)
    pairs.emplace_back(std::min(flat[i], flat[i + 1]), std::max(flat[i], flat[i + 1]));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

int eccentricity(const Adjacency& graph, int vertex) {
  std::vector<int> depth;
  return depth[static_cast<std::size_t>(breadth_first(graph, std::span(&vertex, 1), depth).back())];
}

}  // namespace

TEST_CASE("coarse levels: the authors' levels on three meshes, from two centres each", "[graph][parity]") {
  if (!parity::is_here()) return;
  const Npz npz = parity::open("coarse_levels");
  for (const std::string mesh : {"tube", "strip", "holed"}) {
    const std::vector<int> faces = parity::integers(npz, mesh + "_faces");
    const int vertices = *std::ranges::max_element(faces) + 1;
    const Surface surface = parity::surface(npz, mesh + "_faces", vertices);
    const std::vector<int> centres = parity::integers(npz, mesh + "_centers");
    for (std::size_t k = 0; k < centres.size(); ++k) {
      INFO(mesh << ", centre " << centres[k]);
      const CoarseLevels made = make_coarse_levels(surface, 4, std::span(&centres[k], 1));
      const std::string name = mesh + "_c" + std::to_string(k);
      for (int level = 0; level < 4; ++level)
        CHECK((pairs_of(made.levels[static_cast<std::size_t>(level)]) ==
               their_level(npz, name + "_level" + std::to_string(level))));
      CHECK(made.vertex_level == parity::integers(npz, name + "_vertex_level"));
    }
    const std::vector<int> least = parity::integers(npz, mesh + "_graph_centers");
    CHECK(make_coarse_levels(surface, 1).centres == std::vector<int>{*std::ranges::min_element(least)});
  }
}

TEST_CASE("coarse levels: the centre is the lowest vertex of least eccentricity", "[graph]") {
  std::mt19937 random(5);
  for (int n = 0; n < 40; ++n) {
    PairList pairs;  // a tree with some more edges
    const int count = 30 + n;
    for (int v = 1; v < count; ++v)
      pairs.emplace_back(static_cast<int>(random() % std::min(v, 1 + n % 9)) + v - std::min(v, 1 + n % 9), v);
    for (int i = 0; i < n; ++i) {
      const int a = static_cast<int>(random() % count), b = static_cast<int>(random() % count);
      if (a != b) pairs.emplace_back(a, b);
    }
    const Adjacency graph = adjacency_of(count, unique_edges(pairs));
    std::pair<int, int> best{count, -1};
    for (int v = 0; v < count; ++v) best = std::min(best, {eccentricity(graph, v), v});
    CHECK(graph_centre(graph, static_cast<int>(random() % count)) == best.second);
    CHECK(eccentricity(graph, approximate_graph_centre(graph, 0)) <= 2 * best.first);
  }
}

TEST_CASE("coarse levels: one component at a time, none where it is too small", "[graph]") {
  const fake::Mesh strip = fake::grid(3, 20);
  const CoarseLevels alone = make_coarse_levels(fake::surface_of(strip), 4);
  CHECK(alone.levels[2].rows() > 0);
  CHECK(alone.centres.size() == 1);

  fake::Mesh both = strip;
  fake::add(both, fake::two_triangles(), {0, 1, 0});
  fake::add(both, strip, {0, 2, 0});
  const CoarseLevels made = make_coarse_levels(fake::surface_of(both), 4);
  const int shift = static_cast<int>(strip.x.rows()) + 4;
  REQUIRE(made.centres.size() == 3);
  CHECK(made.centres[2] == alone.centres[0] + shift);
  for (std::size_t level = 0; level < 4; ++level) {
    PairList wanted = pairs_of(alone.levels[level]), second = wanted;
    for (auto& [a, b] : second) a += shift, b += shift;
    wanted.insert(wanted.end(), second.begin(), second.end());
    CHECK((pairs_of(made.levels[level]) == wanted));
  }
  for (int v = shift - 4; v < shift; ++v) CHECK(made.vertex_level[static_cast<std::size_t>(v)] == 0);

  // A path of e + 1 rings from its end has level l exactly if e >= 2^(l + 1).
  for (int rings = 2; rings < 20; ++rings) {
    const std::vector<int> first{0};
    const Surface surface = fake::surface_of(fake::grid(2, rings));
    const int reach = eccentricity(adjacency_of(surface.vertex_count, surface.edges), 0);
    const CoarseLevels levels = make_coarse_levels(surface, 4, first);
    for (int level = 0; level < 4; ++level) {
      INFO(rings << " rings, level " << level);
      CHECK((levels.levels[static_cast<std::size_t>(level)].rows() > 0) == (reach >= 2 << level));
    }
  }
}

TEST_CASE("coarse discs: a strip by hand, pieces apart, few edges at any numbering", "[graph]") {
  const fake::Mesh strip = fake::grid(2, 11);
  const Surface narrow = fake::surface_of(strip);
  const CoarseLevels made = make_coarse_discs(narrow, strip.x, 3);
  REQUIRE(made.levels.size() == 3);
  for (const Edges& level : made.levels)
    for (const auto& edge : level.rowwise()) CHECK(edge[0] < edge[1]);
  CHECK(made.levels[0].rows() >= 3);
  CHECK(made.levels[1].rows() <= made.levels[0].rows());
  CHECK(made.levels[2].rows() == 0);  // one disc of 14.4 edges holds all

  fake::Mesh both = strip;
  fake::add(both, strip, {0, 2, 0});
  const CoarseLevels two = make_coarse_discs(fake::surface_of(both), both.x, 3);
  const int shift = static_cast<int>(strip.x.rows());
  for (std::size_t level = 0; level < 3; ++level) {
    PairList wanted = pairs_of(made.levels[level]), second = wanted;
    for (auto& [a, b] : second) a += shift, b += shift;
    wanted.insert(wanted.end(), second.begin(), second.end());
    CHECK((pairs_of(two.levels[level]) == wanted));
  }

  // A square sheet: each level joins far fewer vertices than the one before, and all of its centres hang together.
  const fake::Mesh sheet = fake::grid(30, 30);
  const Surface surface = fake::surface_of(sheet);
  const CoarseLevels levels = make_coarse_discs(surface, sheet.x, 2);
  CHECK(levels.levels[0].rows() < surface.edges.rows() / 4);
  CHECK(levels.levels[1].rows() < levels.levels[0].rows() / 3);
  for (const Edges& level : levels.levels) {
    const Adjacency graph = adjacency_of(surface.vertex_count, level);
    const int first = level(0, 0);
    std::vector<int> depth;
    const std::vector<int> reached = breadth_first(graph, std::span(&first, 1), depth);
    for (Eigen::Index i = 0; i < level.size(); ++i) CHECK(depth[static_cast<std::size_t>(level.data()[i])] >= 0);
  }
}

}  // namespace selvedge::test_coarse_levels

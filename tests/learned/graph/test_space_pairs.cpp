#include <catch2/catch.hpp>

#include <chrono>

#include "collision/geometry/adjacency.hpp"
#include "tests/learned/graph_scenes.hpp"

namespace selvedge::test_space_pairs {

namespace {

// Two layers close to each other, and a third one far away.
fake::World layers(double gap) {
  fake::Mesh mesh = fake::grid(9, 11, 0.012);
  fake::add(mesh, fake::grid(8, 9, 0.013), {0.003, gap, 0.002});
  fake::add(mesh, fake::grid(4, 4), {-5, 2, 1e6});
  fake::World world = fake::world(mesh);
  fake::jitter(world.state.x, 1e-3, 3);
  return world;
}

// By all pairs.
std::vector<SpacePair> pairs_by_definition(const fake::World& world, const SpaceOptions& options) {
  const Adjacency mesh = adjacency_of(world.scene.cloth.vertex_count, world.scene.cloth.edges);
  std::vector<SpacePair> pairs;
  for (int a = 0; a < world.state.x.rows(); ++a)
    for (int b = a + 1; b < world.state.x.rows(); ++b) {
      const bool joined = std::ranges::count(mesh.of(a), b) > 0;
      const bool near_at_rest = (world.scene.rest.row(a) - world.scene.rest.row(b)).norm() < options.radius;
      if ((world.state.x.row(a) - world.state.x.row(b)).norm() < options.radius && (options.mesh_pairs || !joined) &&
          (options.rest_pairs || !near_at_rest))
        pairs.push_back({a, b});
    }
  return pairs;
}

std::vector<SpacePair> found_pairs(const fake::World& world, const SpaceOptions& options) {
  SpaceSearch search;
  return find_space_pairs(world.scene, world.state.x, options, search).pairs;
}

}  // namespace

TEST_CASE("space pairs: all vertices within the radius but for mesh edges", "[learned]") {
  for (const double gap : {0.004, 0.015}) {
    const fake::World world = layers(gap);
    for (const bool with_mesh : {false, true})
      for (const bool with_rest : {false, true}) {
        SpaceOptions options;
        options.mesh_pairs = with_mesh;
        options.rest_pairs = with_rest;
        CHECK(found_pairs(world, options) == pairs_by_definition(world, options));
      }
  }
  CHECK(found_pairs(layers(0.004), {}).size() > 300);
}

TEST_CASE("space pairs: the released form has ten nearest, one way", "[learned]") {
  const fake::World world = layers(0.004);
  SpaceOptions options;
  options.nearest = 10;
  options.mesh_pairs = true;
  options.radius = 0.03;
  const std::vector<SpacePair> pairs = found_pairs(world, options), all = pairs_by_definition(world, options);
  CHECK(pairs.size() < all.size());
  CHECK(std::ranges::includes(all, pairs));
  std::vector<int> at(static_cast<std::size_t>(world.state.x.rows()), 0);
  for (const SpacePair& pair : pairs)
    for (const int v : pair) ++at[v];
  for (int v = 0; v < 171; ++v) CHECK(at[v] >= 9);  // its own, and those that chose it
}

TEST_CASE("space pairs: the radius may go with the mesh, and overflow is counted", "[learned]") {
  const fake::World world = layers(0.004);
  SpaceOptions options;
  options.radius_in_edges = 1.3;
  SpaceSearch search;
  find_space_pairs(world.scene, world.state.x, options, search);
  CHECK(search.radius == Approx(1.3 * mean_edge(world.scene.cloth, world.scene.rest)));

  const std::size_t all = found_pairs(world, {}).size(), vertices = static_cast<std::size_t>(world.state.x.rows());
  SpaceOptions few;
  few.pairs_per_vertex = 1;
  SpaceSearch other;
  const SpacePairs kept = find_space_pairs(world.scene, world.state.x, few, other);
  CHECK(kept.pairs.size() == vertices);
  CHECK(static_cast<std::size_t>(kept.beyond) == all - vertices);
}

TEST_CASE("space pairs: a graph has them as a set with the columns of mesh edges", "[learned]") {
  fake::World world = layers(0.004);
  world.state.acceleration = Points::Random(world.state.x.rows(), 3);
  FeatureOptions options = senc_features();
  options.coarse_levels = 0;
  options.coarse_sets.clear();
  CHECK(node_widths(options).all == 27);
  CHECK(node_widths(options).normalised == 24);
  const RestGraph rest = make_rest_graph(world.scene, options);
  GraphSearch search;
  GraphReport report;
  Graph graph;
  make_raw_graph(world.scene, rest, world.state, options, fake::tables(options), search, graph, report);
  REQUIRE(graph.edge_sets.back().key == "space_edge");
  const EdgeSet& set = graph.edge_sets.back();
  const std::size_t half = report.space_pairs.pairs.size();
  REQUIRE(set.senders.size() == 2 * half);
  for (std::size_t e = 0; e < half; ++e) {
    CHECK(set.senders[e] == set.receivers[e + half]);
    const auto features = set.features.row(static_cast<Eigen::Index>(e));
    const Vec3 now = row(world.state.x, set.senders[e]) - row(world.state.x, set.receivers[e]);
    CHECK((features.head<3>().transpose().cast<double>() - now).norm() < 1e-6);
    CHECK(features[3] == Approx(now.norm()));
    CHECK(features[7] ==
          Approx((world.scene.rest.row(set.senders[e]) - world.scene.rest.row(set.receivers[e])).norm()));
  }
  CHECK((graph.nodes.block(0, 21, graph.cloth_nodes, 3).cast<double>() - world.state.acceleration).norm() < 1e-5);

  options.space.nearest = 10;
  make_raw_graph(world.scene, rest, world.state, options, fake::tables(options), search, graph, report);
  CHECK(graph.edge_sets.back().senders.size() == report.space_pairs.pairs.size());
}

TEST_CASE("space pairs: time for 12,000 vertices", "[learned][.long]") {
  fake::Mesh mesh = fake::grid(80, 75, 0.014);
  fake::add(mesh, fake::grid(80, 75, 0.014), {0.004, 0.006, 0.003});
  fake::World world = fake::world(mesh);
  fake::jitter(world.state.x, 1e-3, 3);
  SpaceSearch search;
  double best = 1e9;
  std::size_t pairs = 0;
  for (int i = 0; i < 9; ++i) {
    const auto start = std::chrono::steady_clock::now();
    pairs = find_space_pairs(world.scene, world.state.x, {}, search).pairs.size();
    best = std::min(best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  WARN(pairs << " pairs in " << best << " ms");
}

}  // namespace selvedge::test_space_pairs

#include <catch2/catch.hpp>
#include <functional>

#include "tests/learned/graph_scenes.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_graph_scenes {

using namespace selvedge::fake;

namespace {

const std::vector<FeatureOptions> all_forms{hood_features(), hood_cvpr_features(), fine_features(),
                                            contourcraft_features(), contourcraft_paper_features()};

void check_sound(const MadeGraph& made, const FeatureOptions& options) {
  CHECK(made.report.refused == "");
  CHECK(all_finite(made.graph));
  CHECK(made.graph.nodes.cols() == node_widths(options).all);
  const std::vector<std::string> keys = edge_set_keys(options);
  REQUIRE(made.graph.edge_sets.size() == keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const EdgeSet& set = made.graph.edge_sets[i];
    CHECK(set.key == keys[i]);
    CHECK(set.features.rows() == static_cast<Eigen::Index>(set.senders.size()));
    for (std::size_t e = 0; e < set.senders.size(); ++e) {
      CHECK(std::max(set.senders[e], set.receivers[e]) < made.graph.nodes.rows());
      CHECK(std::min(set.senders[e], set.receivers[e]) >= 0);
    }
  }
}

Mesh two_layers(int n, double apart) {
  Mesh mesh = grid(n, n);
  add(mesh, grid(n, n), {0.004, apart, 0.003});
  return mesh;
}

}  // namespace

TEST_CASE("graph: small and scattered cloths make sound graphs in every form", "[graph]") {
  Mesh pieces;
  for (int i = 0; i < 20; ++i) add(pieces, i % 3 == 0 ? grid(5, 7) : two_triangles(), {0.01 * (i % 5), 0.02 * i, 0});
  for (const FeatureOptions& options : all_forms) {
    check_sound(made_graph(world(two_triangles()), options), options);
    check_sound(made_graph(world(grid(3, 4)), options), options);
    check_sound(made_graph(world(grid(3, 4), grid(4, 4)), options), options);
    check_sound(made_graph(world(pieces, grid(4, 4)), options), options);
    World pinned = world(two_triangles(), grid(4, 4));
    pinned.scene.types.assign(4, pinned_vertex);
    check_sound(made_graph(pinned, options), options);
    World massless = world(two_triangles());
    massless.scene.mass.assign(4, 0);
    check_sound(made_graph(massless, options), options);
    World omitted = world(grid(3, 4), grid(4, 4));
    omitted.scene.body_types.assign(16, omitted_body_vertex);
    const MadeGraph made = made_graph(omitted, options);
    check_sound(made, options);
    CHECK(made.graph.body_vertices.empty());
    CHECK(made.report.omitted_body_pairs == 12);
  }
}

TEST_CASE("graph: a cloth whose points all fall together is finite", "[graph]") {
  for (const FeatureOptions& options : all_forms) {
    World collapsed = world(two_layers(5, 0.01), grid(4, 4));
    collapsed.state.x.setZero();
    collapsed.state.previous.setZero();
    check_sound(made_graph(collapsed, options), options);
  }
}

TEST_CASE("graph: what is not finite is refused, and says so", "[graph]") {
  for (const double bad : {std::nan(""), HUGE_VAL, 1e300}) {
    for (int which = 0; which < 7; ++which) {
      World broken = world(grid(4, 4), grid(3, 3));
      GraphState& s = broken.state;
      Points* const parts[]{&s.x, &s.previous, &s.target, &s.velocity, &s.body, &s.body_previous, &s.body_target};
      (*parts[which])(3, 1) = bad;
      const MadeGraph made = made_graph(broken, contourcraft_features());
      CHECK(made.report.refused != "");
      CHECK(made.graph.nodes.rows() == 0);
    }
    World broken = world(grid(4, 4));
    broken.scene.rest(2, 2) = bad;
    if (!std::isfinite(bad)) CHECK_THROWS(made_graph(broken, hood_features()));
  }
  World broken = world(grid(4, 4));
  broken.state.velocity.conservativeResize(15, 3);
  CHECK_THROWS(made_graph(broken, hood_features()));
  FeatureTables narrow = tables(hood_features());
  narrow.node.mean.pop_back();
  const World fine = world(grid(4, 4));
  GraphSearch search;
  MadeGraph made;
  CHECK_THROWS(make_graph(fine.scene, make_rest_graph(fine.scene, hood_features()), fine.state, hood_features(), narrow,
                          search, made.graph, made.report));
}

TEST_CASE("graph: the same bits on one and two threads, with and without what was kept", "[graph]") {
  World moving = world(two_layers(24, 0.01), grid(20, 20, 0.03));
  for (int v = 0; v < 24; ++v) moving.scene.types[static_cast<std::size_t>(v)] = pinned_vertex;
  for (const FeatureOptions& options : {hood_features(), contourcraft_features()}) {
    GraphSearch kept;
    MadeGraph one;
    for (unsigned frame = 0; frame < 4; ++frame) {
      jitter(moving.state.x, 0.004 * frame, 7 + frame);
      jitter(moving.state.body, 0.002 * frame, 11 + frame);
      MadeGraph two;
      with_threads(1, [&] { make_again(moving, options, kept, one); });
      with_threads(2, [&] { two = made_graph(moving, options); });
      CHECK(same_graph(one.graph, two.graph));
      if (options.cloth_edges) CHECK(one.report.cloth_pairs.repulsion.size() > 500);
    }
  }
}

TEST_CASE("graph: pairs are kept for the next pass, and found anew once anything that they depend on changes",
          "[graph]") {
  World moving = world(two_layers(12, 0.01), grid(10, 10, 0.03));
  for (int v = 0; v < 12; ++v) moving.scene.types[static_cast<std::size_t>(v)] = pinned_vertex;
  GraphState& s = moving.state;
  const std::vector<std::pair<std::string, std::function<void()>>> changes{
      {"nothing", [] {}},
      {"guess", [&] { s.guess = s.x + Points::Constant(s.x.rows(), 3, 0.01); }},
      {"a vertex", [&] { s.x(100, 1) += 0.015; }},
      {"a pinned target", [&] { s.target.row(3).array() += 0.02; }},
      {"a pinned velocity", [&] { s.velocity.row(4).array() += 0.03; }},
      {"a vertex of the body", [&] { s.body.row(40).array() += 0.02; }},
      {"no edges of cloth", [&] { s.no_cloth_edges = true; }},
      {"no edges in space", [&] { s.no_space_edges = true; }}};
  for (FeatureOptions options : {hood_features(), contourcraft_features()}) {
    options.space_edges = true;
    GraphSearch kept;
    MadeGraph again;
    make_again(moving, options, kept, again);
    const World start = moving;
    for (const auto& [what, change] : changes) {
      INFO(what);
      change();
      make_again(moving, options, kept, again);
      CHECK(same_graph(again.graph, made_graph(moving, options).graph));
    }
    moving = start;
  }
}

TEST_CASE("graph: pairs beyond the limit are counted, the farthest of them", "[graph]") {
  const World close = world(two_layers(6, 0.01));
  FeatureOptions options = contourcraft_features();
  const PairClasses all = made_graph(close, options).report.cloth_pairs;
  REQUIRE(all.repulsion.size() > 0);
  options.cloth_pairs_per_vertex = 0;
  const GraphReport none = made_graph(close, options).report;
  CHECK(none.cloth_pairs.repulsion.empty());
  CHECK(none.cloth_pairs_beyond == static_cast<int>(all.repulsion.size()));
  std::vector<ClothPair> pairs{{1, 5, 0, 0, 0.02}, {2, 3, 0, 0, 0.01}, {2, 4, 0, 0, 0.03}, {7, 1, 0, 0, 0.015}};
  CHECK(keep_nearest_pairs(pairs, 2) == 2);
  REQUIRE(pairs.size() == 2);
  CHECK((pairs[0].vertex == 2 && pairs[1].vertex == 7));
}

TEST_CASE("graph: what a set leaves out is left out", "[graph]") {
  World layered = world(two_layers(8, 0.01), grid(9, 9));
  FeatureOptions options = contourcraft_features();
  layered.state.no_cloth_edges = true;
  const MadeGraph none = made_graph(layered, options);
  CHECK(none.graph.edge_sets[6].key == "repulsion_edge");
  CHECK(none.graph.edge_sets[6].senders.empty());
  options.cloth_edges = false;
  options.body_key.clear();
  options.coarse_sets = {3};
  check_sound(made_graph(layered, options), options);
  CHECK((edge_set_keys(options) == std::vector<std::string>{"mesh_edge", "coarse_edge3"}));
  options.coarse_sets = {4};
  CHECK_THROWS(made_graph(layered, options));
}

TEST_CASE("graph: materials are of each vertex, and of an edge the mean of its ends", "[graph]") {
  World made = world(two_layers(4, 0.01), grid(3, 3));
  for (int v = 0; v < made.scene.cloth.vertex_count; ++v) {
    const auto n = static_cast<float>(v);
    made.scene.materials.row(v) << 0.01f * n, 1 - 0.01f * n, 0.5f;
  }
  const Graph graph = made_graph(made, contourcraft_features()).graph;
  CHECK(graph.nodes(5, 21) == Approx(0.05f));
  CHECK(graph.nodes(graph.nodes.rows() - 1, 21) == -1);
  for (const std::size_t set : {0u, 1u, 6u}) {
    const EdgeSet& edges = graph.edge_sets[set];
    REQUIRE(edges.senders.size() > 0);
    const Eigen::Index column = edges.features.cols() - 3;
    for (std::size_t e = 0; e < edges.senders.size(); ++e)
      CHECK(edges.features(static_cast<Eigen::Index>(e), column) ==
            Approx(0.005 * (edges.senders[e] + edges.receivers[e])));
  }
}

}  // namespace selvedge::test_graph_scenes

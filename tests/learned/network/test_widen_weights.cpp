#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "learned/network/engine.hpp"
#include "learned/network/widen_weights.hpp"
#include "tests/learned/graph_scenes.hpp"
#include "tests/learned/network_by_definition.hpp"

namespace selvedge::test_widen_weights {

namespace {

Architecture narrow(const std::string& preset) {
  Architecture a = architecture_preset(preset);
  a.width = 12;
  return a;
}

FeatureRows result_of(const Architecture& a, const NetworkWeights& weights, const fake::World& world) {
  GraphSearch search;
  GraphReport report;
  const RestGraph rest = make_rest_graph(world.scene, a.features);
  Graph graph;
  make_graph(world.scene, rest, world.state, a.features, weights.tables, search, graph, report);
  return by_definition::infer(a, weights, graph);
}

}  // namespace

TEST_CASE("a network widened for space edges and accelerations begins as it was", "[learned]") {
  fake::Mesh mesh = fake::grid(9, 9, 0.012);
  fake::add(mesh, fake::grid(8, 8, 0.013), {0.003, 0.005, 0.002});
  fake::World world = fake::world(mesh, fake::grid(5, 5, 0.03));
  fake::jitter(world.state.x, 1e-3, 3);
  world.state.acceleration = Points::Random(world.state.x.rows(), 3);
  const Architecture from = narrow("hood"), to = narrow("senc");
  CHECK_NOTHROW(check_architecture(to, "senc"));
  const NetworkWeights weights = random_weights(from, 1);
  NetworkWeights wide = widen_weights(from, weights, to, 2);
  const FeatureRows before = result_of(from, weights, world), after = result_of(to, wide, world);
  REQUIRE(before.rows() == after.rows());
  CHECK((before - after).cwiseAbs().maxCoeff() < 1e-6);
  // Not because nothing is read: a weight that is no longer zero shows.
  wide.steps[0].node.layers[0].weight.setConstant(0.1f);
  CHECK((before - result_of(to, wide, world)).cwiseAbs().maxCoeff() > 1e-4);

  CHECK_THROWS_AS(widen_weights(to, random_weights(to, 1), from, 2), Error);
}

TEST_CASE("our small network widened for what SENC sees begins as it was", "[learned]") {
  fake::Mesh mesh = fake::grid(9, 9, 0.012);
  fake::add(mesh, fake::grid(8, 8, 0.013), {0.003, 0.005, 0.002});
  fake::World world = fake::world(mesh, fake::grid(5, 5, 0.03));
  world.state.acceleration = Points::Random(world.state.x.rows(), 3);
  world.state.no_cloth_edges = true;  // stage 1 had none
  const Architecture from = narrow("small_contour");
  NetworkWeights weights = random_weights(from, 1);
  const FeatureRows before = result_of(from, weights, world);
  for (const std::string preset : {"small_senc", "small_senc_layers"}) {
    INFO(preset);
    const Architecture to = narrow(preset);
    CHECK_NOTHROW(check_architecture(to, preset));
    NetworkWeights wide = widen_weights(from, weights, to, 2);
    world.state.no_cloth_edges = true;  // those in space are there, and weigh nothing yet
    const FeatureRows after = result_of(to, wide, world);
    REQUIRE(before.rows() == after.rows());
    CHECK((before - after).cwiseAbs().maxCoeff() < 1e-6);
    world.state.no_cloth_edges = false;
    const FeatureRows with_edges = result_of(to, wide, world);
    // Of the edges in space, the last kind. One column alone: the normalised sums of a row would add up to nothing.
    wide.steps[0].node.layers[0].weight.rightCols(1).setConstant(0.1f);
    CHECK((with_edges - result_of(to, wide, world)).cwiseAbs().maxCoeff() > 1e-4);
  }
  // Edges of cloth with cloth that a network was trained with are not dropped.
  weights.tables.world_edge.mean[0] = 0.01f;
  CHECK_THROWS_AS(widen_weights(from, weights, narrow("small_senc"), 2), Error);
  CHECK_NOTHROW(widen_weights(from, weights, narrow("small_senc_layers"), 2));
}

}  // namespace selvedge::test_widen_weights

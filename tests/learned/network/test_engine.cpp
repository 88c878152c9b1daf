#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "collision/geometry/error.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "learned/network/engine_bench.hpp"
#include "learned/network/packed_network.hpp"
#include "tests/learned/network_by_definition.hpp"
#include "tests/learned/random_graph.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_engine {

using in_tests::random_graph;
using in_tests::with_size;

namespace {

const std::vector<InstructionSet> all_sets{InstructionSet::plain, InstructionSet::avx2, InstructionSet::avx512};

float largest(const FeatureRows& a) { return a.size() == 0 ? 0 : a.cwiseAbs().maxCoeff(); }

// Of all latents and the output, relative to the largest.
float difference(const FeatureRows& a, const FeatureRows& b) {
  REQUIRE(a.rows() == b.rows());
  REQUIRE(a.cols() == b.cols());
  if (a.size() == 0) return 0;
  REQUIRE(a.allFinite());
  return largest(a - b) / std::max(1.f, largest(b));
}

void check_same(const Architecture& a, const Graph& graph, InstructionSet set) {
  const NetworkWeights weights = random_weights(a, 5);
  LatentTrace ours, theirs;
  const FeatureRows output = infer(*pack_network(a, weights, set), graph, &ours);
  CHECK(difference(output, by_definition::infer(a, weights, graph, &theirs)) < 1e-5f);
  CHECK(output.rows() == graph.cloth_nodes);
  REQUIRE(ours.nodes.size() == theirs.nodes.size());
  for (std::size_t i = 0; i < ours.nodes.size(); ++i) CHECK(difference(ours.nodes[i], theirs.nodes[i]) < 1e-5f);
  REQUIRE(ours.edges_first.size() == theirs.edges_first.size());
  for (std::size_t i = 0; i < ours.edges_first.size(); ++i) {
    CHECK(difference(ours.edges_first[i], theirs.edges_first[i]) < 1e-5f);
    CHECK(difference(ours.edges_last[i], theirs.edges_last[i]) < 1e-5f);
  }
  // Without a trace the same bits come out, though sets that no step uses are not encoded.
  CHECK(infer(*pack_network(a, weights, set), graph) == output);
}

FeatureRows infer_on(int threads, const PackedNetwork& network, const Graph& graph) {
  FeatureRows output;
  with_threads(threads, [&] { output = infer(network, graph); });
  return output;
}

}  // namespace

TEST_CASE("engine: asks between steps of messages whether to stop", "[learned]") {
  const Architecture a = with_size("hood", 16, 15);
  const auto network = pack_network(a, random_weights(a, 5));
  const Graph graph = random_graph(a, 50, 20, 150, 1);
  int asked = 0;
  const StopFlag stop = [&] { return ++asked == 4; };
  const StopScope scope(stop);
  CHECK_THROWS_AS(infer(*network, graph), Stopped);
  CHECK(asked == 4);
}

TEST_CASE("engine: every instruction set computes what the definition says", "[learned]") {
  for (const InstructionSet set : all_sets) {
    if (!is_supported(set)) continue;
    INFO(name_of(set));
    check_same(with_size("hood", 16, 15), random_graph(with_size("hood", 16, 15), 50, 20, 150, 1), set);
    check_same(with_size("contourcraft", 32, 2), random_graph(with_size("contourcraft", 32, 2), 70, 11, 220, 2), set);
    check_same(with_size("small", 64, 1), random_graph(with_size("small", 64, 1), 101, 0, 250, 3), set);
    for (const int width : {1, 7, 20, 33})
      check_same(with_size("fine15", width, 2), random_graph(with_size("fine15", width, 2), 50, 9, 131, 4), set);
    Architecture deep = with_size("hood", 12, 6);
    deep.hidden_layers = 4;
    deep.layer_norm = false;
    check_same(deep, random_graph(deep, 30, 5, 77, 5), set);
  }
}

TEST_CASE("engine: with 16-bit integers every row is as near as their rounding allows", "[learned]") {
  if (!is_supported(InstructionSet::vnni)) {
    WARN("left out: this processor has no kernels for int16");
    return;
  }
  const auto check_near = [](const Architecture& a, const Graph& graph) {
    const NetworkWeights weights = random_weights(a, 5);
    LatentTrace ours, theirs;
    const auto network = pack_network(a, weights, InstructionSet::vnni);
    const FeatureRows output = infer(*network, graph, &ours);
    CHECK(difference(output, by_definition::infer(a, weights, graph, &theirs)) < 2e-3f);
    for (std::size_t i = 0; i < ours.nodes.size(); ++i) CHECK(difference(ours.nodes[i], theirs.nodes[i]) < 2e-3f);
    CHECK(infer_on(2, *network, graph) == output);
  };
  check_near(with_size("hood", 16, 15), random_graph(with_size("hood", 16, 15), 50, 20, 150, 1));
  check_near(with_size("small", 64, 1), random_graph(with_size("small", 64, 1), 101, 0, 250, 3));
  check_near(with_size("small", 300, 2), random_graph(with_size("small", 300, 2), 30, 0, 80, 3));  // several slices
  for (const int width : {1, 7, 20, 33})
    check_near(with_size("fine15", width, 2), random_graph(with_size("fine15", width, 2), 50, 9, 131, 4));
  const Architecture a = with_size("hood", 16, 9);
  check_near(a, random_graph(a, 0, 0, 0, 1));
  check_near(a, random_graph(a, 24, 0, 24, 1));
}

TEST_CASE("engine: sums of 16-bit integers do not overflow, whatever the inputs", "[learned]") {
  if (!is_supported(InstructionSet::vnni)) {
    WARN("left out: this processor has no kernels for int16");
    return;
  }
  // Inputs and weights at their largest, of one sign: the largest sum that there can be.
  Architecture a = with_size("hood", 64, 0);
  a.layer_norm = false;
  a.encoders.clear();
  a.edge_kinds.clear();
  a.steps.clear();
  NetworkWeights weights = random_weights(a, 1);
  for (const WeightArray& array : weight_arrays(a, weights)) std::fill_n(array.data, array.rows * array.columns, 0.7f);
  Graph graph;
  graph.cloth_nodes = 3;
  graph.nodes = FeatureRows::Constant(3, a.node_inputs, 1e3f);
  CHECK(difference(infer(*pack_network(a, weights, InstructionSet::vnni), graph),
                   by_definition::infer(a, weights, graph)) < 1e-3f);
}

TEST_CASE("engine: small and empty graphs", "[learned]") {
  const Architecture a = with_size("hood", 16, 9);
  for (const InstructionSet set : all_sets) {
    if (!is_supported(set)) continue;
    check_same(a, random_graph(a, 0, 0, 0, 1), set);
    check_same(a, random_graph(a, 1, 0, 0, 1), set);
    check_same(a, random_graph(a, 3, 0, 4, 1), set);
    check_same(a, random_graph(a, 4, 2, 1, 1), set);
    check_same(a, random_graph(a, 24, 0, 24, 1), set);
    Graph no_sets = random_graph(a, 25, 1, 5, 1);
    no_sets.edge_sets.clear();
    check_same(a, no_sets, set);
    Graph some = random_graph(a, 25, 1, 50, 1);
    some.edge_sets.erase(some.edge_sets.begin());
    check_same(a, some, set);
    std::swap(some.edge_sets[0], some.edge_sets[2]);  // the order of sets does not matter to the sums
    check_same(a, some, set);
  }
}

TEST_CASE("engine: a filter keeps an edge only if its cloth end has an edge in one of the sets", "[learned]") {
  Architecture a = with_size("hood", 16, 1);
  a.steps[0] = {{"world_edge"}, {{"world_edge", {"coarse_edge1"}}}};
  Graph graph = random_graph(a, 4, 1, 0, 1);
  const auto set = [&graph](const std::string& key) -> EdgeSet& {
    for (EdgeSet& one : graph.edge_sets)
      if (one.key == key) return one;
    throw std::logic_error(key);
  };
  set("coarse_edge1").senders = {0};
  set("coarse_edge1").receivers = {1};
  set("coarse_edge1").features = FeatureRows::Zero(1, 12);
  set("world_edge").senders = {1, 2, 4, 4};
  set("world_edge").receivers = {4, 4, 1, 2};
  set("world_edge").features = FeatureRows::Random(4, 9);
  LatentTrace trace;
  infer(*pack_network(a, random_weights(a, 1)), graph, &trace);
  const std::size_t world = 1;
  REQUIRE(graph.edge_sets[world].key == "world_edge");
  for (const int edge : {0, 1, 2, 3}) {
    const bool kept = edge == 0 || edge == 2;
    CHECK((trace.edges_last[world].row(edge) != trace.edges_first[world].row(edge)) == kept);
  }
}

TEST_CASE("engine: one and two threads give the same bits", "[learned]") {
  const Architecture a = with_size("contourcraft", 48, 4);
  const Graph graph = random_graph(a, 700, 60, 2500, 7);
  for (const InstructionSet set : all_sets) {
    if (!is_supported(set)) continue;
    const auto network = pack_network(a, random_weights(a, 2), set);
    std::vector<FeatureRows> outputs;
    for (const int threads : {1, 2, 3, 2}) outputs.push_back(infer_on(threads, *network, graph));
    for (const FeatureRows& output : outputs) CHECK(output == outputs.front());
  }
}

TEST_CASE("engine: weights that are no numbers give no numbers, and nothing worse", "[learned]") {
  const Architecture a = with_size("hood", 16, 4);
  const Graph graph = random_graph(a, 50, 5, 200, 1);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    NetworkWeights weights = random_weights(a, 2);
    weights.steps[1].node.layers[0].weight(3, 5) = bad;
    CHECK(infer(*pack_network(a, weights), graph).array().isNaN().all());
    if (is_supported(InstructionSet::vnni))
      CHECK(!infer(*pack_network(a, weights, InstructionSet::vnni), graph).allFinite());
    for (const WeightArray& array : weight_arrays(a, weights)) std::fill_n(array.data, array.rows * array.columns, bad);
    CHECK(infer(*pack_network(a, weights), graph).array().isNaN().all());
  }
  Graph odd = graph;
  odd.nodes(0, 0) = std::numeric_limits<float>::quiet_NaN();
  CHECK(infer(*pack_network(a, random_weights(a, 2)), odd).row(0).array().isNaN().all());
}

TEST_CASE("engine: a graph that does not fit the network is an error that says where", "[learned]") {
  const Architecture a = with_size("hood", 16, 2);
  const auto network = pack_network(a, random_weights(a, 2));
  const auto place = [&](const auto& change) {
    Graph graph = random_graph(a, 10, 2, 20, 1);
    change(graph);
    try {
      infer(*network, graph);
    } catch (const Error& error) {
      return error.where();
    }
    return std::string("none");
  };
  CHECK(place([](Graph&) {}) == "none");
  CHECK(place([](Graph& g) { g.cloth_nodes = 13; }) == "graph");
  CHECK(place([](Graph& g) { g.cloth_nodes = -1; }) == "graph");
  CHECK(place([](Graph& g) { g.nodes = FeatureRows::Zero(12, 23); }) == "graph: nodes");
  CHECK(place([](Graph& g) { g.edge_sets[0].senders[3] = 12; }) == "graph: mesh_edge");
  CHECK(place([](Graph& g) { g.edge_sets[1].receivers[3] = -1; }) == "graph: world_edge");
  CHECK(place([](Graph& g) { g.edge_sets[1].receivers.pop_back(); }) == "graph: world_edge");
  CHECK(place([](Graph& g) { g.edge_sets[0].features = FeatureRows::Zero(20, 9); }) == "graph: mesh_edge");
  CHECK(place([](Graph& g) { g.edge_sets[0].key = "repulsion_edge"; }) == "graph: repulsion_edge");
  CHECK(place([](Graph& g) { g.edge_sets[0].key = "world_edge"; }) == "graph: world_edge");
  NetworkWeights wrong = random_weights(a, 2);
  wrong.decoder.layers[0].weight.resize(16, 15);
  CHECK_THROWS_AS(pack_network(a, wrong), Error);
  for (const InstructionSet set : all_sets)
    if (!is_supported(set)) CHECK_THROWS_AS(pack_network(a, random_weights(a, 2), set), Error);
}

TEST_CASE("engine: operations and bytes are counted", "[learned]") {
  // 5,000 nodes, 30,000 edges, width 128, 15 steps: a step has 6 products of 128 x 128 a node and 3 an edge.
  const Architecture a = bench_architecture(128, 15), none = bench_architecture(128, 0);
  const Graph graph = grid_graph(a, 5000);
  CHECK(graph.edge_sets[0].senders.size() == 30000);
  CHECK(count_operations(a, graph) - count_operations(bench_architecture(128, 1), graph) ==
        Approx(14 * 2.0 * 128 * 128 * (6 * 5000 + 3 * 30000)));
  CHECK(count_operations(none, graph) == Approx(2.0 * 128 * (5000 * (24 + 128 + 128) + 5000 * (128 + 128 + 3))));
  // One row a node and an edge, one sum and two products a node.
  CHECK(count_bytes(a, graph) == Approx((4 * 5000 + 30000) * 512.0).epsilon(.01));
  CHECK(count_bytes(none, graph) == Approx(5000 * 512.0).epsilon(.01));
}

TEST_CASE("engine: what is measured is what was run", "[learned]") {
  const PeakMeasurement peak = measure_peak(InstructionSet::plain, 1);
  CHECK(peak.lanes == 4);
  CHECK(peak.threads >= 1);
  CHECK(peak.flops > 1e8);
  CHECK(peak.clock > 1e8);
  const Architecture a = bench_architecture(16, 2);
  const EngineMeasurement one = measure_engine(*pack_network(a, random_weights(a, 1)), grid_graph(a, 100), 2);
  CHECK(one.nodes == 100);
  CHECK(one.edges == 600);
  CHECK(one.seconds > 0);
  CHECK(one.operations == count_operations(a, grid_graph(a, 100)));
}

TEST_CASE("engine: memory between runs changes no bit, whether edges stay or change", "[learned]") {
  for (const std::string name : {"student", "small_contour"}) {
    INFO(name);
    const Architecture a = architecture_preset(name);
    const auto network = pack_network(a, random_weights(a, 5));
    EngineMemory memory;
    Graph graph = random_graph(a, 60, 5, 300, 11);
    const auto same = [&] { return (infer(*network, graph, memory).array() == infer(*network, graph).array()).all(); };
    CHECK(same());
    const GraphPlan& plan = memory.plan;
    const int* order = plan.order[0].data();
    graph.nodes *= 0.5f;
    CHECK(same());
    CHECK(plan.order[0].data() == order);  // the plan was kept
    std::swap(graph.edge_sets[0].senders[0], graph.edge_sets[0].senders[1]);
    CHECK(same());
    graph = random_graph(a, 47, 0, 250, 12);
    CHECK(same());
    graph = random_graph(a, 70, 3, 400, 13);
    CHECK(same());
  }
}

}  // namespace selvedge::test_engine

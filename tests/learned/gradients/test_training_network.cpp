#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "learned/gradients/training_network.hpp"
#include "learned/network/packed_network.hpp"
#include "tests/learned/network_in_double.hpp"
#include "tests/learned/random_graph.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_training_network {

using in_tests::random_graph;
using in_tests::with_size;

namespace {

const std::vector<InstructionSet> all_sets{InstructionSet::plain, InstructionSet::avx2, InstructionSet::avx512};

// Statistics as of data: each column its own, none of them 1.
NetworkWeights weights_with_statistics(const Architecture& a, std::uint64_t seed) {
  NetworkWeights weights = random_weights(a, seed);
  for (const WeightArray& array : weight_arrays(a, weights))
    for (int k = 0; !array.trained && k < array.rows; ++k)
      array.data[k] =
          array.name.ends_with("/mean") ? 0.1f * static_cast<float>(k) : 0.5f + 0.07f * static_cast<float>(k);
  for (const WeightArray& array : weight_arrays(a, weights))  // norms that are not the identity
    for (int k = 0; array.name.find("/norm/") != std::string::npos && k < array.rows; ++k)
      array.data[k] += 0.05f * static_cast<float>(k % 7) - 0.1f;
  return weights;
}

// A graph whose embedding columns hold what the weights' tables give.
Graph embedded_graph(const Architecture& a, const NetworkWeights& weights, Graph graph) {
  const EmbeddingColumns at = embedding_columns(a.features);
  const auto put = [](const FeatureRows& table, const std::vector<int>& values, int first, const Statistics& statistics,
                      FeatureRows& rows) {
    for (std::size_t i = 0; i < values.size(); ++i)
      for (Eigen::Index k = 0; k < table.cols(); ++k) {
        const auto column = static_cast<std::size_t>(first + k);
        rows(static_cast<Eigen::Index>(i), first + k) =
            (table(values[i], k) - statistics.mean[column]) / statistics.deviation[column];
      }
  };
  put(weights.tables.node_type, graph.node_types, at.type, weights.tables.node, graph.nodes);
  put(weights.tables.vertex_level, graph.node_levels, at.level, weights.tables.node, graph.nodes);
  for (EdgeSet& set : graph.edge_sets)
    if (!set.labels.empty())
      put(weights.tables.edge_type, set.labels, at.label, statistics_for(set.key, a.features, weights.tables),
          set.features);
  return graph;
}

FeatureRows weighting(Eigen::Index rows, Eigen::Index columns) {
  return FeatureRows::NullaryExpr(rows, columns, [](Eigen::Index i, Eigen::Index k) {
    return std::sin(1.7f * static_cast<float>(i) + 0.6f * static_cast<float>(k) + 0.3f);
  });
}

// Every `stride`th entry of every array, and for each array the largest difference relative to its largest entry.
double worst_difference(const Architecture& a, const NetworkWeights& weights, const Graph& graph,
                        const WeightGradients& gradients, int stride) {
  in_double::Arrays arrays = in_double::arrays_of(a, weights);
  const in_double::Arrays found = in_double::arrays_of(a, gradients);
  const in_double::Matrix factors = weighting(graph.cloth_nodes, a.outputs).cast<double>();
  const auto value = [&] { return in_double::output(a, arrays, weights.tables, graph).cwiseProduct(factors).sum(); };
  NetworkWeights copy = weights;
  double worst = 0;
  for (const WeightArray& array : weight_arrays(a, copy)) {
    if (!array.trained) {
      CHECK(found.at(array.name).isZero());
      continue;
    }
    const double largest = std::max(found.at(array.name).cwiseAbs().maxCoeff(), 1e-3);
    in_double::Matrix& changed = arrays[array.name];
    for (Eigen::Index k = array.rows % stride; k < changed.size(); k += stride) {
      constexpr double h = 1e-6;
      const double before = changed.data()[k];
      changed.data()[k] = before + h;
      const double up = value();
      changed.data()[k] = before - h;
      const double slope = (up - value()) / (2 * h);
      changed.data()[k] = before;
      const double off = std::abs(slope - found.at(array.name).data()[k]) / largest;
      if (off > 1e-4)
        UNSCOPED_INFO(array.name << " entry " << k << ": " << found.at(array.name).data()[k] << ", " << slope);
      worst = std::max(worst, off);
    }
  }
  return worst;
}

WeightGradients gradients_of(const TrainingNetwork& network, const Graph& graph) {
  Tape tape;
  const FeatureRows output = run_forward(network, graph, tape);
  WeightGradients gradients = zero_gradients(network.architecture);
  run_backward(network, graph, tape, weighting(output.rows(), output.cols()), gradients);
  return gradients;
}

void check_gradients(const Architecture& a, const Graph& plain, InstructionSet set, int stride) {
  const NetworkWeights weights = weights_with_statistics(a, 5);
  const Graph graph = embedded_graph(a, weights, plain);
  const TrainingNetwork network = make_training_network(a, weights, set);
  Tape tape;
  const FeatureRows output = run_forward(network, graph, tape);
  const in_double::Matrix exact = in_double::output(a, in_double::arrays_of(a, weights), weights.tables, graph);
  REQUIRE((output.cast<double>() - exact).cwiseAbs().maxCoeff() < 1e-4 * std::max(1., exact.cwiseAbs().maxCoeff()));
  CHECK(worst_difference(a, weights, graph, gradients_of(network, graph), stride) < 1e-4);
}

bool same_bits(const Architecture& a, WeightGradients one, WeightGradients other) {
  const std::vector<WeightArray> first = weight_arrays(a, one), second = weight_arrays(a, other);
  for (std::size_t i = 0; i < first.size(); ++i)
    if (!std::equal(first[i].data, first[i].data + static_cast<std::ptrdiff_t>(first[i].rows) * first[i].columns,
                    second[i].data))
      return false;
  return true;
}

}  // namespace

TEST_CASE("training network: derivatives are those of the network in double, for every feature", "[learned]") {
  for (const InstructionSet set : all_sets) {
    if (!is_supported(set)) continue;
    INFO(name_of(set));
    const int stride = set == best_instruction_set() ? 13 : 97;
    Architecture hood = with_size("hood", 7, 7);  // filters, two hidden layers, embeddings, an encoder that is not used
    check_gradients(hood, random_graph(hood, 9, 4, 15, 1), set, stride);
    Architecture shared = with_size("hood_cvpr", 5, 4);  // one encoder for several sets
    shared.steps[0].edge_keys = {"coarse_edge0", "coarse_edge1", "coarse_edge2"};
    check_gradients(shared, random_graph(shared, 9, 2, 8, 2), set, stride);
    Architecture contour = with_size("contourcraft", 8, 2);  // labels of edges
    check_gradients(contour, random_graph(contour, 8, 3, 13, 3), set, stride);
    Architecture small = with_size("small_contour", 33, 1);  // one hidden layer, more than one panel
    check_gradients(small, random_graph(small, 7, 0, 9, 4), set, 5 * stride);
    Architecture deep = with_size("fine15", 6, 2);
    deep.hidden_layers = 3;
    deep.layer_norm = false;
    deep.outputs = 5;
    check_gradients(deep, random_graph(deep, 6, 2, 11, 5), set, stride);
  }
}

TEST_CASE("training network: derivatives where sums and parts reach over many tiles", "[learned]") {
  Architecture a = with_size("small", 6, 2);
  a.encoders.resize(1);
  a.edge_kinds.resize(1);
  for (MessageStep& step : a.steps) step.edge_keys = {"mesh_edge"};
  const Graph graph = random_graph(a, 400, 0, 1500, 6);
  const NetworkWeights weights = random_weights(a, 3);
  CHECK(worst_difference(a, weights, graph, gradients_of(make_training_network(a, weights), graph), 131) < 1e-4);
}

TEST_CASE("training network: going forward is the engine, and a tape can be used again for another graph",
          "[learned]") {
  Tape tape;
  for (const std::string& name : preset_names()) {
    INFO(name);
    const Architecture a = with_size(name, 20, 5);
    const TrainingNetwork network = make_training_network(a, random_weights(a, 4));
    for (const int edges : {150, 0, 61, 1}) {
      const Graph graph = random_graph(a, 40 + edges, 11, edges, 9);
      const FeatureRows ours = run_forward(network, graph, tape);
      const FeatureRows engine = infer(*pack_network(a, network.weights), graph);
      CHECK((ours - engine).cwiseAbs().maxCoeff() < 1e-5f * std::max(1.f, engine.cwiseAbs().maxCoeff()));
      WeightGradients again = zero_gradients(a);
      run_backward(network, graph, tape, weighting(ours.rows(), ours.cols()), again);
      CHECK(same_bits(a, again, gradients_of(network, graph)));
    }
    Graph none = random_graph(a, 0, 0, 0, 1);
    CHECK(run_forward(network, none, tape).rows() == 0);
    WeightGradients nothing = zero_gradients(a);
    run_backward(network, none, tape, FeatureRows(0, 3), nothing);
    CHECK(same_bits(a, nothing, zero_gradients(a)));
  }
}

TEST_CASE("training network: one and several threads give the same bits", "[learned]") {
  const Architecture a = with_size("small_contour", 48, 3);
  const Graph graph = random_graph(a, 700, 0, 2500, 7);
  const TrainingNetwork network = make_training_network(a, random_weights(a, 2));
  std::vector<WeightGradients> all;
  for (const int threads : {1, 2, 3, 2}) with_threads(threads, [&] { all.push_back(gradients_of(network, graph)); });
  for (const WeightGradients& one : all) CHECK(same_bits(a, one, all.front()));
}

TEST_CASE("training network: gradients are added up, and other weights are seen once they are laid out", "[learned]") {
  const Architecture a = with_size("tiny", 8, 2);
  const Graph graph = random_graph(a, 20, 0, 40, 3);
  TrainingNetwork network = make_training_network(a, random_weights(a, 2));
  Tape tape;
  const FeatureRows before = run_forward(network, graph, tape);
  WeightGradients twice = zero_gradients(a);
  run_backward(network, graph, tape, weighting(20, 3), twice);
  run_backward(network, graph, tape, weighting(20, 3), twice);
  WeightGradients once = gradients_of(network, graph);
  for (const WeightArray& array : weight_arrays(a, once))
    for (int i = 0; i < array.rows * array.columns; ++i) array.data[i] *= 2;
  CHECK(same_bits(a, once, twice));
  network.weights = random_weights(a, 9);
  lay_out(network);
  const FeatureRows after = run_forward(network, graph, tape);
  CHECK(after != before);
  CHECK((after - infer(*pack_network(a, network.weights), graph)).cwiseAbs().maxCoeff() < 1e-5f);
}

TEST_CASE("training network: what does not fit is an error", "[learned]") {
  const Architecture a = with_size("tiny", 8, 2);
  const Graph graph = random_graph(a, 20, 0, 40, 3), other = random_graph(a, 21, 0, 40, 3);
  const TrainingNetwork network = make_training_network(a, random_weights(a, 2));
  Tape tape;
  WeightGradients gradients = zero_gradients(a);
  CHECK_THROWS_AS(run_backward(network, graph, tape, weighting(20, 3), gradients), Error);
  run_forward(network, graph, tape);
  CHECK_NOTHROW(run_backward(network, graph, tape, weighting(20, 3), gradients));
  CHECK_THROWS_AS(run_backward(network, other, tape, weighting(21, 3), gradients), Error);
  CHECK_THROWS_AS(run_backward(network, graph, tape, weighting(19, 3), gradients), Error);
  CHECK_THROWS_AS(run_backward(network, graph, tape, weighting(20, 2), gradients), Error);
  WeightGradients small = zero_gradients(with_size("tiny", 8, 1));
  CHECK_THROWS_AS(run_backward(network, graph, tape, weighting(20, 3), small), Error);
  CHECK_THROWS_AS(make_training_network(a, random_weights(with_size("tiny", 9, 2), 1)), Error);
}

}  // namespace selvedge::test_training_network

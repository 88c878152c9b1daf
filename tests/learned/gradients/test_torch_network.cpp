#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "learned/gradients/torch_network.hpp"
#include "learned/network/packed_network.hpp"
#include "tests/learned/random_graph.hpp"

namespace selvedge::test_torch_network {

using in_tests::random_graph;
using in_tests::with_size;

// With libtorch: hidden, `make torch` runs it.

namespace {

FeatureRows some_derivatives(Eigen::Index rows, Eigen::Index columns) {
  return FeatureRows::NullaryExpr(rows, columns, [](Eigen::Index i, Eigen::Index k) {
    return std::sin(1.7f * static_cast<float>(i) + 0.6f * static_cast<float>(k));
  });
}

}  // namespace

TEST_CASE("torch network: without its library there is an error that says so", "[learned]") {
  const Architecture a = with_size("tiny", 8, 1);
  try {
    TorchNetwork(a, random_weights(a, 1), "cpu", 1, "nowhere/libselvedge_torch.so");
    FAIL("it was loaded");
  } catch (const Error& error) {
    CHECK(error.where() == "nowhere/libselvedge_torch.so");
    CHECK(std::string(error.what()).find("libtorch") != std::string::npos);
  }
  CHECK_THROWS_AS(TorchNetwork(a, random_weights(a, 1), "tpu", 1), Error);
}

TEST_CASE("torch network: every preset has the engine's output and the kernels' gradients", "[.torch]") {
  for (const std::string& name : preset_names()) {
    INFO(name);
    const Architecture a = with_size(name, 20, 7);
    const Graph graph = random_graph(a, 60, 11, 170, 9);
    TrainingNetwork network = make_training_network(a, random_weights(a, 4));
    TorchNetwork torch(a, network.weights, "auto", 1);
    CHECK(torch.facts().threads == 1);
    CHECK(torch.facts().gemm_flops > 0);
    const FeatureRows engine = infer(*pack_network(a, network.weights), graph), theirs = torch.infer(graph);
    CHECK((engine - theirs).cwiseAbs().maxCoeff() < 1e-5f * std::max(1.f, engine.cwiseAbs().maxCoeff()));
    Tape tape;
    const FeatureRows output = run_forward(network, graph, tape), d = some_derivatives(output.rows(), output.cols());
    WeightGradients ours = zero_gradients(a), other = zero_gradients(a);
    run_backward(network, graph, tape, d, ours);
    CHECK(torch.run_forward(graph) == theirs);  // on a GPU too
    torch.run_backward(graph, network.weights.tables, d, other);
    const std::vector<WeightArray> one = weight_arrays(a, ours), two = weight_arrays(a, other);
    for (std::size_t i = 0; i < one.size(); ++i) {
      if (!one[i].trained) continue;
      INFO(one[i].name);
      const auto size = static_cast<Eigen::Index>(one[i].rows) * one[i].columns;
      const Eigen::Map<const Eigen::VectorXf> mine(one[i].data, size), torchs(two[i].data, size);
      CHECK((mine - torchs).cwiseAbs().maxCoeff() <= 1e-4f * torchs.cwiseAbs().maxCoeff() + 1e-6f);
    }
  }
}

TEST_CASE("torch network: weights go in and out, and a step of Adam changes them", "[.torch]") {
  const Architecture a = with_size("tiny", 16, 2);
  const Graph graph = random_graph(a, 30, 0, 90, 2);
  const NetworkWeights first = random_weights(a, 4), second = random_weights(a, 5);
  TorchNetwork torch(a, first, "cpu", 1);
  const FeatureRows before = torch.infer(graph);
  torch.set_weights(second);
  CHECK(torch.infer(graph) != before);
  NetworkWeights out = random_weights(a, 6);
  torch.get_weights(out);
  CHECK(out.steps[1].edges[2].layers[0].weight == second.steps[1].edges[2].layers[0].weight);
  torch.train(graph, some_derivatives(30, 3), 1e-2);
  torch.get_weights(out);
  const FeatureRows change = out.decoder.layers[1].weight - second.decoder.layers[1].weight;
  CHECK(change.cwiseAbs().maxCoeff() == Approx(1e-2).epsilon(1e-3));  // Adam's first step is the rate
  WeightGradients gradients = zero_gradients(a);
  CHECK_THROWS_AS(torch.run_backward(graph, second.tables, some_derivatives(30, 3), gradients),
                  Error);  // nothing was kept
}

}  // namespace selvedge::test_torch_network

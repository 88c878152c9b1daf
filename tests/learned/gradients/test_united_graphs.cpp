#include <catch2/catch.hpp>

#include "learned/gradients/training_network.hpp"
#include "learned/graph/unite_graphs.hpp"
#include "tests/learned/random_graph.hpp"

namespace selvedge::test_united_graphs {

using in_tests::random_graph;
using in_tests::with_size;

namespace {

FeatureRows weighting(Eigen::Index rows, Eigen::Index columns, float phase) {
  return FeatureRows::NullaryExpr(rows, columns, [&](Eigen::Index i, Eigen::Index k) {
    return std::sin(1.7f * static_cast<float>(i) + 0.6f * static_cast<float>(k) + phase);
  });
}

}  // namespace

// No edge connects the graphs of a batch, so that each gets the output that it gets alone, and the gradient of the sum
// is the sum of the gradients.
TEST_CASE("united graphs: outputs and gradients are those of the graphs alone", "[training_network]") {
  for (const char* preset : {"hood", "contourcraft", "small", "small_senc_layers"}) {
    INFO(preset);
    const Architecture a = with_size(preset, 16, 2);
    std::vector<Graph> graphs{random_graph(a, 40, 9, 150, 1), random_graph(a, 25, 0, 90, 2),
                              random_graph(a, 33, 12, 120, 3)};
    graphs[1].edge_sets.pop_back();  // one of them has no edges of this kind
    const TrainingNetwork network = make_training_network(a, random_weights(a, 5));
    Graph united;
    unite_graphs(std::vector<const Graph*>{&graphs[0], &graphs[1], &graphs[2]}, united);
    CHECK(united.cloth_nodes == 98);
    CHECK(united.nodes.rows() == 119);

    Tape tape;
    const FeatureRows together = run_forward(network, united, tape);
    FeatureRows d_output(98, a.outputs);
    WeightGradients alone = zero_gradients(a), of_all = zero_gradients(a);
    Eigen::Index first = 0;
    for (std::size_t g = 0; g < graphs.size(); ++g) {
      Tape own;
      const FeatureRows output = run_forward(network, graphs[g], own);
      // Sums over edges are cut at other places, so that rounding differs.
      CHECK((together.middleRows(first, output.rows()) - output).cwiseAbs().maxCoeff() <=
            1e-5f * output.cwiseAbs().maxCoeff());
      const FeatureRows d = weighting(output.rows(), a.outputs, static_cast<float>(g));
      d_output.middleRows(first, output.rows()) = d;
      run_backward(network, graphs[g], own, d, alone);
      first += output.rows();
    }
    run_backward(network, united, tape, d_output, of_all);
    const std::vector<WeightArray> expected = weight_arrays(a, alone), found = weight_arrays(a, of_all);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      using Numbers = Eigen::Map<const Eigen::VectorXf>;
      const Numbers one(expected[k].data, expected[k].rows * expected[k].columns),
          other(found[k].data, found[k].rows * found[k].columns);
      INFO(expected[k].name);
      CHECK((one - other).cwiseAbs().maxCoeff() <= 1e-4f * std::max(one.cwiseAbs().maxCoeff(), 1e-3f));
    }
  }
}

}  // namespace selvedge::test_united_graphs

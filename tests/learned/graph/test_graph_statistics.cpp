#include <catch2/catch.hpp>

#include "learned/graph/integration.hpp"
#include "pipeline/weights/import_weights.hpp"
#include "tests/learned/parity_edges.hpp"

namespace selvedge::test_graph_statistics {

using namespace selvedge::parity;

namespace {

// The sums in a checkpoint, which statistics are made of.
Accumulators sums_in(TorchArchive& archive, const std::string& set) {
  const PickleValue* module = find(archive.pickle(), archive.root(), "training_module");
  REQUIRE(module);
  const auto values = [&](const std::string& part) {
    const std::string name = "model._" + set + "_normalizer._" + part;
    const PickleValue* value = find(archive.pickle(), *module, name);
    REQUIRE(value);
    return archive.floats(std::get<TorchTensor>(*value), name);
  };
  Accumulators sums;
  sums.rows = values("acc_count")[0];
  sums.updates = values("num_accumulations")[0];
  sums.sum = values("acc_sum");
  sums.sum_squared = values("acc_sum_squared");
  return sums;
}

FeatureSums<float> all_sums(TorchArchive& archive, bool contourcraft) {
  FeatureSums<float> sums;
  sums.node = sums_in(archive, "node");
  sums.mesh_edge = sums_in(archive, "mesh_edge");
  sums.world_edge = sums_in(archive, "world_edge");
  sums.output = sums_in(archive, "output");
  if (!contourcraft) return sums;
  sums.coarse_edge = sums_in(archive, "coarse_edge");
  sums.body_edge = sums_in(archive, "body_edge");
  return sums;
}

void check_sums(const Npz& npz, const std::string& set, const Accumulators& ours) {
  INFO(set);
  const std::string name = "after_" + set + "_normalizer_";
  CHECK(static_cast<double>(ours.rows) == npz.numbers(name + "acc_count").values[0]);
  CHECK(static_cast<double>(ours.updates) == npz.numbers(name + "num_accumulations").values[0]);
  for (const bool squared : {false, true}) {
    const std::vector<double> theirs = npz.numbers(name + (squared ? "acc_sum_squared" : "acc_sum")).values;
    const std::vector<float>& sums = squared ? ours.sum_squared : ours.sum;
    REQUIRE(sums.size() == theirs.size());
    double largest = 0, apart = 0;
    for (std::size_t k = 0; k < theirs.size(); ++k) {
      largest = std::max(largest, std::abs(theirs[k]));
      apart = std::max(apart, std::abs(theirs[k] - static_cast<double>(sums[k])));
    }
    CHECK(apart <= 1e-6 * largest);
  }
}

double limit_of_column(const std::string& key, Eigen::Index column) {
  const bool nearly_constant =
      (key == "node" && column == 8) || ((key == "repulsion_edge" || key == "attraction_edge") && column == 13);
  return nearly_constant ? 1e-3 : 1e-5;
}

void check_columns(const std::string& key, const FeatureRows& ours, const FeatureRows& theirs) {
  INFO(key);
  REQUIRE(ours.cols() == theirs.cols());
  for (Eigen::Index k = 0; k < ours.cols(); ++k) {
    INFO("column " << k);
    CHECK(difference(ours, theirs, k, 1) <= limit_of_column(key, k));
  }
}

}  // namespace

TEST_CASE("graph statistics: in float32, each operation rounded", "[graph][parity]") {
  if (!is_here()) return;
  TorchArchive archive(folder() / "hood_w16.pth");
  const Accumulators sums = sums_in(archive, "node");
  const Statistics made = statistics_of(sums);
  CHECK(made.deviation[8] == Approx(1.73e-4).epsilon(0.01));  // 1.62e-4 with a fused multiply-add
  CHECK(made.deviation[14] == 1e-8f);
}

TEST_CASE("graph statistics: a training step gathers and normalises as the authors' code does", "[graph][parity]") {
  if (!is_here()) return;
  for (const std::string name : {"hood_step_training", "ccraft_fold_training"}) {
    INFO(name);
    const Case c = load(name);
    const bool contourcraft = name.starts_with("ccraft");
    const std::filesystem::path file = folder() / (contourcraft ? "ccraft_w16.pth" : "hood_w16.pth");
    TorchArchive archive(file);
    FeatureSums<float> sums = all_sums(archive, contourcraft);
    FeatureTables tables = read_published_weights(file).weights.tables;
    const RestGraph rest = make_rest_graph(c.scene, c.options, c.centres);
    GraphSearch search;
    GraphReport report;
    Graph graph;
    make_raw_graph(c.scene, rest, c.state, c.options, tables, search, graph, report);
    gather_and_normalise(c.options, sums, tables, graph);
    const FeatureRows accelerations = target_accelerations(rest, c.state, c.options);
    CHECK(difference(accelerations, rows(c.npz, "target_acceleration_raw")) <= 2e-7);
    accumulate(sums.output, accelerations);
    check_sums(c.npz, "node", sums.node);
    check_sums(c.npz, "mesh_edge", sums.mesh_edge);
    check_sums(c.npz, "world_edge", sums.world_edge);
    check_sums(c.npz, "output", sums.output);
    if (contourcraft) {
      check_sums(c.npz, "coarse_edge", sums.coarse_edge);
      check_sums(c.npz, "body_edge", sums.body_edge);
    }
    check_columns("node", graph.nodes, rows(c.npz, "node_features"));
    for (const std::string& key : edge_set_keys(c.options)) {
      const std::string array = file_name(key) + "_features";
      if (c.npz.has(array)) check_columns(key, their_order(c, graph, report, key), rows(c.npz, array));
    }
  }
}

TEST_CASE("graph statistics: sums of no rows, of some, and of enough", "[graph]") {
  DoubleAccumulators sums(2);
  CHECK(statistics_of(sums).deviation[1] == 1e-8f);
  FeatureRows some(4, 3);
  some << 1, 5, 9, 2, 5, 9, 3, 5, 9, 6, 5, 9;
  accumulate(sums, some);
  accumulate(sums, FeatureRows(0, 3));
  CHECK(sums.updates == 2);
  const Statistics made = statistics_of(sums);
  CHECK(made.mean[0] == 3);
  CHECK(made.deviation[0] == Approx(std::sqrt(3.5)));
  CHECK(made.deviation[1] == 1e-8f);
  normalise(made, some);
  CHECK(some(0, 0) == Approx(-2 / std::sqrt(3.5)));
  CHECK(some(3, 1) == 0);
  CHECK(some(2, 2) == 9);
  sums.updates = most_updates;
  accumulate(sums, some);
  CHECK(sums.rows == 4);
  const FeatureSums<double> empty = empty_sums(contourcraft_features());
  CHECK(empty.node.sum.size() == 20);
  CHECK(empty.world_edge.sum.size() == 16);
  CHECK(empty.body_edge.sum.size() == 12);
  CHECK(empty_sums(hood_features()).world_edge.sum.size() == 9);
}

}  // namespace selvedge::test_graph_statistics

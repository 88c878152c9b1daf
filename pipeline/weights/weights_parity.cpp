#include "pipeline/weights/weights_parity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/geometry/error.hpp"
#include "learned/graph/integration.hpp"
#include "learned/graph/make_graph.hpp"
#include "learned/network/engine.hpp"
#include "learned/network/packed_network.hpp"
#include "pipeline/host/numbers_json.hpp"

namespace selvedge {
namespace {

using EdgePairs = std::vector<std::pair<int, int>>;

// mesh_edge_index, coarse0_edge_index, world_edge_index, ..
std::string recorded_edges_name(const std::string& key) {
  return key.starts_with("coarse_edge") ? "coarse" + key.substr(11) + "_edge_index" : key + "_index";
}

EdgePairs recorded_pairs(const Npz& file, const std::string& name) {
  const NpyArray<std::int64_t> array = file.integers(name);
  if (array.shape.size() != 2 || array.shape[0] != 2)
    throw Error("needs two rows", file.place(name).text(), "row 0 holds the senders, row 1 the receivers");
  EdgePairs pairs;
  const auto count = static_cast<std::size_t>(array.shape[1]);
  for (std::size_t e = 0; e < count; ++e)
    pairs.emplace_back(static_cast<int>(array.values[e]), static_cast<int>(array.values[count + e]));
  return pairs;
}

// The edges of the set. Edges between cloth and body are given one way only, with the body's own vertex numbers.
EdgePairs graph_pairs(const Graph& graph, const EdgeSet& set) {
  EdgePairs pairs;
  for (std::size_t e = 0; e < set.senders.size(); ++e) {
    const int sender = set.senders[e], receiver = set.receivers[e], body = receiver - graph.cloth_nodes;
    if (sender >= graph.cloth_nodes) continue;
    pairs.emplace_back(sender, body < 0 ? receiver : graph.body_vertices[static_cast<std::size_t>(body)]);
  }
  return pairs;
}

double not_in_both(EdgePairs a, EdgePairs b) {
  std::ranges::sort(a);
  std::ranges::sort(b);
  EdgePairs apart;
  std::ranges::set_symmetric_difference(a, b, std::back_inserter(apart));
  return static_cast<double>(apart.size());
}

// The largest difference; infinite for another shape, or if only one of both is finite.
double recorded_distance(const Eigen::MatrixXd& ours, const NpyArray<double>& theirs) {
  if (theirs.shape.size() != 2 || theirs.shape[0] != ours.rows() || theirs.shape[1] != ours.cols())
    return std::numeric_limits<double>::infinity();
  double most = 0;
  for (Eigen::Index i = 0; i < ours.rows(); ++i)
    for (Eigen::Index k = 0; k < ours.cols(); ++k) {
      const double difference = std::abs(ours(i, k) - theirs.values[static_cast<std::size_t>(i * ours.cols() + k)]);
      if (std::isnan(difference)) return std::numeric_limits<double>::infinity();
      most = std::max(most, difference);
    }
  return most;
}

double largest_recorded(const NpyArray<double>& array) {
  double most = 0;
  for (const double value : array.values) most = std::max(most, std::abs(value));
  return most;
}

void compare_graph(const Graph& graph, const RestGraph& rest, const Npz& file, ParityReport& report) {
  for (const EdgeSet& set : graph.edge_sets)
    if (const std::string name = recorded_edges_name(set.key); file.has(name))
      report.rows.push_back({set.key, "edges", not_in_both(graph_pairs(graph, set), recorded_pairs(file, name)), 0});
  if (file.has("cloth_vertex_level")) {
    const NpyArray<double> theirs = file.numbers("cloth_vertex_level");
    Eigen::MatrixXd ours(static_cast<Eigen::Index>(rest.vertex_levels.size()), 1);
    for (Eigen::Index v = 0; v < ours.rows(); ++v) ours(v, 0) = rest.vertex_levels[static_cast<std::size_t>(v)];
    report.rows.push_back({"vertex_level", "", recorded_distance(ours, {{ours.rows(), 1}, theirs.values}), 0});
  }
}

// Sums in float32 of the same numbers in another order agree to about 1e-7 of the largest.
void compare_sums(const FeatureSums<float>& sums, const StatisticsSizes& sizes, const Npz& file, ParityReport& report) {
  const auto compare = [&](const std::string& set, const Accumulators& ours, int columns) {
    if (columns == 0) return;
    const auto add = [&](const std::string& name, const std::vector<float>& values) {
      const NpyArray<double> theirs = file.numbers("after_" + set + "_normalizer_" + name);
      const Eigen::Map<const Eigen::RowVectorXf> row(values.data(), static_cast<Eigen::Index>(values.size()));
      const Eigen::MatrixXd mine = row.cast<double>();
      report.rows.push_back(
          {set + " " + name, "", recorded_distance(mine, theirs), 1e-6 * std::max(1.0, largest_recorded(theirs))});
    };
    add("acc_sum", ours.sum);
    add("acc_sum_squared", ours.sum_squared);
  };
  visit_statistics(compare, sums, sizes);
}

}  // namespace

ParityReport weights_parity(const Architecture& architecture, const NetworkWeights& weights, const ParityDump& dump,
                            const FeatureSums<float>* sums) {
  if (dump.gathered && !sums)
    throw Error("was recorded while statistics were gathered", dump.file.place("after_node_normalizer_acc_sum").text(),
                "give the checkpoint (.pth) in place of the weight file, which has no sums of the statistics");
  const FeatureOptions& options = architecture.features;
  const RestGraph rest = make_rest_graph(dump.scene, options, dump.centres);
  GraphSearch search;
  GraphReport found;
  Graph graph;
  make_raw_graph(dump.scene, rest, dump.state, options, weights.tables, search, graph, found);
  if (!found.refused.empty()) throw Error(found.refused, dump.file.place("cloth_pos").text(), "record another step");
  FeatureSums<float> after;
  FeatureTables tables = weights.tables;
  if (dump.gathered) {
    after = *sums;
    gather_and_normalise(options, after, tables, graph);
    accumulate(after.output, target_accelerations(rest, dump.state, options));  // for the steps that follow
  } else {
    normalise(options, tables, graph);
  }
  const FeatureRows output = infer(*pack_network(architecture, weights), graph);
  const NextCloth next = integrate(rest, dump.state, options, tables.output, output);

  ParityReport report{architecture.name, graph.cloth_nodes, static_cast<int>(graph.nodes.rows()), 0, {}};
  for (const EdgeSet& set : graph.edge_sets) report.edges += static_cast<int>(set.senders.size());
  compare_graph(graph, rest, dump.file, report);
  if (dump.file.has("decoder_output")) {
    const NpyArray<double> theirs = dump.file.numbers("decoder_output");
    report.rows.push_back({"decoder_output", "", recorded_distance(output.cast<double>(), theirs),
                           2e-5 * std::max(1.0, largest_recorded(theirs) / 4.2)});
  }
  const NpyArray<double> positions = dump.file.numbers("pred_pos");
  const double growth = std::max(1.0, largest_recorded(positions));
  report.rows.push_back({"pred_pos", "m", recorded_distance(next.x, positions), 1e-7 * growth});
  if (dump.file.has("pred_velocity"))
    report.rows.push_back({"pred_velocity", "m/frame",
                           recorded_distance(next.velocity, dump.file.numbers("pred_velocity")), 1e-7 * growth});
  if (dump.gathered) compare_sums(after, architecture.statistics, dump.file, report);
  return report;
}

bool is_clean(const ParityReport& report) {
  return std::ranges::all_of(report.rows, [](const ParityRow& row) { return row.difference <= row.limit; });
}

std::string parity_text(const ParityReport& report) {
  std::string text = fmt::format("{}: {} cloth vertices, {} nodes, {} directed edges\n", report.network,
                                 report.cloth_vertices, report.nodes, report.edges);
  text += fmt::format("{:<34}{:>12}{:>12}\n", "quantity", "difference", "limit");
  for (const ParityRow& row : report.rows)
    text += fmt::format("{:<34}{:>12.3g}{:>12.3g}  {:<8} {}\n", row.quantity, row.difference, row.limit, row.unit,
                        row.difference <= row.limit ? "same" : "DIFFERS");
  return text;
}

std::string parity_json(const ParityReport& report) {
  Json rows = Json::array();
  for (const ParityRow& row : report.rows)
    rows.push_back({{"quantity", row.quantity},
                    {"unit", row.unit},
                    {"difference", number_or_null(row.difference)},
                    {"limit", row.limit},
                    {"same", row.difference <= row.limit}});
  const Json json = {{"network", report.network}, {"cloth_vertices", report.cloth_vertices},
                     {"nodes", report.nodes},     {"edges", report.edges},
                     {"same", is_clean(report)},  {"quantities", rows}};
  return json_text(json);
}

}  // namespace selvedge

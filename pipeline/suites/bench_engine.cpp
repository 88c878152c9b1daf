#include "pipeline/suites/bench_engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "learned/graph/coarse_levels.hpp"
#include "learned/network/packed_network.hpp"

namespace selvedge {
namespace {

Surface square_sheet(int side) {
  Triangles triangles(2 * (side - 1) * (side - 1), 3);
  Eigen::Index t = 0;
  for (int i = 0; i + 1 < side; ++i)
    for (int j = 0; j + 1 < side; ++j) {
      const int a = i * side + j, b = a + side;
      triangles.row(t++) << a, b, a + 1;
      triangles.row(t++) << b, b + 1, a + 1;
    }
  return make_surface(side * side, triangles);
}

EdgeSet random_edge_set(const Architecture& a, const std::string& key, const Edges& edges) {
  EdgeSet set;
  set.key = key;
  for (const int sender : {0, 1})
    for (const auto& edge : edges.rowwise()) {
      set.senders.push_back(edge[sender]);
      set.receivers.push_back(edge[1 - sender]);
    }
  const int inputs = a.encoders[static_cast<std::size_t>(encoder_of(a, key))].inputs;
  set.features = FeatureRows::Random(static_cast<Eigen::Index>(set.senders.size()), inputs);
  return set;
}

EngineTiming time_network(const Architecture& a, const Graph& graph, int rounds) {
  return {a.name, a.width, static_cast<int>(a.steps.size()), a.passes,
          measure_engine(*pack_network(a, random_weights(a, 1)), graph, rounds)};
}

}  // namespace

Graph sheet_graph(const Architecture& a, int side) {
  const Surface sheet = square_sheet(side);
  Graph graph;
  graph.cloth_nodes = sheet.vertex_count;
  graph.nodes = FeatureRows::Random(sheet.vertex_count, a.node_inputs);
  graph.edge_sets.push_back(random_edge_set(a, "mesh_edge", sheet.edges));
  const CoarseLevels coarse = make_coarse_levels(sheet, a.features.coarse_levels);
  for (const int level : a.features.coarse_sets)
    graph.edge_sets.push_back(
        random_edge_set(a, "coarse_edge" + std::to_string(level), coarse.levels[static_cast<std::size_t>(level)]));
  return graph;
}

bool is_void(const PeakMeasurement& peak) { return !(peak.share_of_ports >= 0.85); }

double share_of_peak(const EngineTimings& timings, const EngineTiming& row) {
  return row.run.operations / row.run.seconds / timings.peak.flops;
}

double busy_share_of_peak(const EngineTimings& timings, const EngineTiming& row) {
  return row.run.operations / row.run.busy_seconds / timings.peak.flops_busy;
}

EngineTimings time_engine(int rounds, int nodes, int small_nodes) {
  EngineTimings timings;
  timings.peak = measure_peak(best_instruction_set(), rounds);
  const Architecture wide = bench_architecture(128, 15), small = architecture_preset("small");
  timings.rows.push_back(time_network(wide, grid_graph(wide, nodes), rounds));
  const int side = std::max(2, static_cast<int>(std::sqrt(static_cast<double>(small_nodes))));
  timings.rows.push_back(time_network(small, sheet_graph(small, side), rounds));
  return timings;
}

std::string engine_table(const EngineTimings& timings) {
  const PeakMeasurement& peak = timings.peak;
  std::string text = fmt::format(
      "network engine: {}, {} threads, {} floats in a vector, {:.2f} GHz; peak {:.1f} GFLOP/s, {:.0f} % of lanes x "
      "ports "
      "x clock{}\n",
      name_of(peak.set), peak.threads, peak.lanes, 1e-9 * peak.clock, 1e-9 * peak.flops, 100 * peak.share_of_ports,
      is_void(peak) ? ": shares are void, other work used the cores" : "");
  text +=
      fmt::format("{:<8} {:>6} {:>6} {:>8} {:>8} {:>8} {:>10} {:>10} {:>10} {:>10} {:>8} {:>13}\n", "network", "width",
                  "steps", "nodes", "edges", "GFLOP", "wall ms", "busy ms", "of peak", "busy", "MB", "runs a frame");
  for (const EngineTiming& row : timings.rows) {
    const auto share = [&](double value) {
      return fmt::format("{:.0f} %{}", 100 * value, is_void(peak) ? " void" : "");
    };
    text += fmt::format("{:<8} {:>6} {:>6} {:>8} {:>8} {:>8.1f} {:>10.1f} {:>10.1f} {:>10} {:>10} {:>8.1f} {:>13}\n",
                        row.network, row.width, row.steps, row.run.nodes, row.run.edges, 1e-9 * row.run.operations,
                        1e3 * row.run.seconds, 1e3 * row.run.busy_seconds, share(share_of_peak(timings, row)),
                        share(busy_share_of_peak(timings, row)), 1e-6 * row.run.bytes, row.passes);
  }
  return text;
}

}  // namespace selvedge

#include "learned/network/engine_bench.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>

#include "collision/geometry/stopwatch.hpp"
#include "learned/network/engine_kernels.hpp"
#include "learned/network/packed_network.hpp"

namespace selvedge {
namespace {

// Seconds of all threads of this process together.
double busy_seconds_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Six operations of one cycle each, each of which waits for the last one.
std::uint64_t chain(std::uint64_t x, long iterations) {
  for (long i = 0; i < iterations; ++i) {
    x ^= x << 13;
    x ^= x >> 7;
    x ^= x << 17;
  }
  return x;
}

double measure_clock() {
  constexpr long iterations = 5000000;
  volatile std::uint64_t keep = 88172645463325252u;
  Stopwatch watch;
  keep = chain(keep, iterations);
  return 6.0 * iterations / watch.lap();
}

// Runs the chains on every thread at once and returns the number of threads.
int exercise_all(const EngineKernels& kernels, long iterations) {
  int threads = 0;
  float kept = 0;
#pragma omp parallel reduction(+ : threads, kept)
  {
    threads += 1;
    kept += kernels.exercise(iterations, .5f);
  }
  return std::isfinite(kept) ? threads : 0;
}

}  // namespace

PeakMeasurement measure_peak(InstructionSet set, int rounds) {
  const EngineKernels& kernels = kernels_for(set);
  PeakMeasurement peak;
  peak.set = set;
  peak.lanes = kernels.lanes;
  constexpr long iterations = 2000000;
  for (int round = 0; round < rounds; ++round) {
    peak.clock = std::max(peak.clock, measure_clock());
    Stopwatch watch;
    const double busy_begin = busy_seconds_now();
    peak.threads = exercise_all(kernels, iterations);
    const double operations = 2.0 * iterations * exercise_chains * kernels.lanes * peak.threads;
    peak.flops = std::max(peak.flops, operations / watch.lap());
    peak.flops_busy = std::max(peak.flops_busy, operations / (busy_seconds_now() - busy_begin));
  }
  peak.share_of_ports = peak.flops / (peak.lanes * 2.0 * 2.0 * peak.clock * peak.threads);
  return peak;
}

EngineMeasurement measure_engine(const PackedNetwork& network, const Graph& graph, int rounds) {
  EngineMeasurement result;
  result.nodes = static_cast<int>(graph.nodes.rows());
  for (const EdgeSet& set : graph.edge_sets) result.edges += static_cast<int>(set.senders.size());
  result.operations = count_operations(network.architecture, graph);
  result.bytes = count_bytes(network.architecture, graph);
  for (int round = 0; round < rounds; ++round) {
    Stopwatch watch;
    const double busy_begin = busy_seconds_now();
    infer(network, graph);
    const double taken = watch.lap(), busy = busy_seconds_now() - busy_begin;
    result.seconds = round == 0 ? taken : std::min(result.seconds, taken);
    result.busy_seconds = round == 0 ? busy : std::min(result.busy_seconds, busy);
  }
  return result;
}

Architecture bench_architecture(int width, int steps) {
  Architecture a;
  a.name = "bench";
  a.width = width;
  a.node_inputs = 24;
  a.encoders = {{"mesh", 12}};
  a.edge_kinds = {{"mesh_edge", 0, 9}};
  a.steps.assign(static_cast<std::size_t>(steps), {{"mesh_edge"}, {}});
  a.statistics = {.node = 21, .mesh_edge = 9};
  return a;
}

Graph grid_graph(const Architecture& a, int nodes) {
  Graph graph;
  graph.cloth_nodes = nodes;
  graph.nodes = FeatureRows::Random(nodes, a.node_inputs);
  EdgeSet set;
  set.key = "mesh_edge";
  const int columns = std::max(2, static_cast<int>(std::sqrt(static_cast<double>(nodes))));
  for (int node = 0; node < nodes; ++node)
    for (const int step : {1, columns - 1, columns}) {
      set.senders.push_back((node + step) % nodes);
      set.receivers.push_back(node);
    }
  const std::vector<int> senders = set.senders;
  set.senders.insert(set.senders.end(), set.receivers.begin(), set.receivers.end());
  set.receivers.insert(set.receivers.end(), senders.begin(), senders.end());
  const int inputs = a.encoders[encoder_of(a, set.key)].inputs;
  set.features = FeatureRows::Random(static_cast<Eigen::Index>(set.senders.size()), inputs);
  graph.edge_sets.push_back(std::move(set));
  return graph;
}

}  // namespace selvedge

#include "pipeline/suites/bench_training.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <optional>

#include "collision/geometry/error.hpp"
#include "collision/geometry/parallel.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "learned/gradients/adam.hpp"
#include "pipeline/suites/bench_engine.hpp"

namespace selvedge {
namespace {

double busy_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Seconds of the rounds; the median is what counts, as other work comes and goes.
struct Laps {
  std::vector<double> wall, busy;

  template <class Work>
  void time(Work&& work) {
    Stopwatch watch;
    const double busy_begin = busy_now();
    work();
    wall.push_back(watch.lap());
    busy.push_back(busy_now() - busy_begin);
  }
  StepSeconds median() const { return {middle(wall), middle(busy)}; }
  static double middle(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : values[values.size() / 2];
  }
};

}  // namespace

TrainingTiming time_training(const std::string& preset, int side, int threads, int rounds,
                             const std::filesystem::path& torch_library) {
  const ThreadLimit limit(threads);
  const Architecture a = architecture_preset(preset);
  const Graph graph = sheet_graph(a, side);
  TrainingNetwork network = make_training_network(a, initial_weights(a, 1));
  TrainingTiming timing;
  timing.network = preset;
  timing.threads = threads;
  timing.nodes = graph.cloth_nodes;
  for (const EdgeSet& set : graph.edge_sets) timing.edges += static_cast<int>(set.senders.size());
  std::optional<TorchNetwork> torch;
  try {
    torch.emplace(a, network.weights, "cpu", threads, torch_library);
    timing.with_torch = true;
    timing.facts = torch->facts();
  } catch (const Error& error) {
    timing.without = error.what();
  }
  Tape tape;
  AdamState state = start_adam(a);
  AdamOptions options;
  options.learning_rate = 1e-5;
  WeightGradients gradients = zero_gradients(a);
  const FeatureRows d_output = FeatureRows::Constant(graph.cloth_nodes, a.outputs, 1e-3f);
  Laps forward, fused, other;
  for (int round = 0; round < rounds; ++round) {
    FeatureRows output, torch_output;
    fused.time([&] {
      forward.time([&] { output = run_forward(network, graph, tape); });
      set_zero(a, gradients);
      run_backward(network, graph, tape, d_output, gradients);
      adam_step(a, options, gradients, state, network.weights);
      lay_out(network);
    });
    if (torch) other.time([&] { torch_output = torch->train(graph, d_output, options.learning_rate); });
    if (torch && round == 0)
      timing.apart = static_cast<double>((output - torch_output).cwiseAbs().maxCoeff() / output.cwiseAbs().maxCoeff());
  }
  timing.forward = forward.median();
  timing.fused = fused.median();
  timing.torch = other.median();
  return timing;
}

std::string training_table(const std::vector<TrainingTiming>& timings) {
  std::string text = fmt::format("{:<14} {:>6} {:>7} {:>8} {:>11} {:>9} {:>9} {:>9} {:>11} {:>12} {:>9}\n", "training",
                                 "nodes", "edges", "threads", "forward ms", "step ms", "busy ms", "steps/s",
                                 "libtorch ms", "libtorch 1/s", "times");
  for (const TrainingTiming& t : timings) {
    text += fmt::format("{:<14} {:>6} {:>7} {:>8} {:>11.1f} {:>9.1f} {:>9.1f} {:>9.1f}", t.network, t.nodes, t.edges,
                        t.threads, 1e3 * t.forward.wall, 1e3 * t.fused.wall, 1e3 * t.fused.busy, 1 / t.fused.wall);
    text += t.with_torch ? fmt::format(" {:>11.1f} {:>12.1f} {:>9.2f}\n", 1e3 * t.torch.wall, 1 / t.torch.wall,
                                       t.torch.wall / t.fused.wall)
                         : " " + t.without + "\n";
  }
  for (const TrainingTiming& t : timings)
    if (t.with_torch)
      return text + fmt::format("libtorch {} on {}, {} threads, {} at {:.0f} GFLOP/s; outputs {:.1e} apart\n",
                                t.facts.version, t.facts.device, t.facts.threads, t.facts.blas,
                                1e-9 * t.facts.gemm_flops, t.apart);
  return text;
}

}  // namespace selvedge

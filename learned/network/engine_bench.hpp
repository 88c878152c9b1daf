#pragma once

#include "learned/network/engine.hpp"
#include "learned/network/engine_kernels.hpp"

namespace selvedge {

// The peak of the cores: multiplications with addition in registers only, on all threads at once.
struct PeakMeasurement {
  InstructionSet set = InstructionSet::plain;
  int threads = 1;
  int lanes = 0;              // floats per vector
  double clock = 0;           // of one core [Hz], from a chain of operations of one cycle each
  double flops = 0;           // of all threads [1/s], best of the rounds; a multiplication with addition counts as two
  double flops_busy = 0;      // per second of one thread's own time [1/s], for machines that others use too
  double share_of_ports = 0;  // of lanes x 2 ports x 2 x clock x threads; a row below 0.85 is void
};
PeakMeasurement measure_peak(InstructionSet, int rounds = 10);

// One network on one graph: best of the rounds.
struct EngineMeasurement {
  int nodes = 0, edges = 0;
  double seconds = 0, operations = 0;
  double busy_seconds = 0;  // time of all threads together, least of the rounds
  double bytes = 0;         // latents, sums and products of one run (`infer`), without weights
};
EngineMeasurement measure_engine(const PackedNetwork&, const Graph&, int rounds = 10);

// A piece of cloth for timing with random features. Its nodes lie row by row on a periodic grid. Each has six
// neighbours, and six directed edges per node have the key mesh_edge and the order of the published sets.
Graph grid_graph(const Architecture&, int nodes);

// The network of the figures in docs/results/benchmarks.md: one set of edges and two hidden layers.
Architecture bench_architecture(int width, int steps);

}  // namespace selvedge

#pragma once

#include <vector>

#include "learned/network/engine.hpp"
#include "learned/network/instruction_set.hpp"

namespace selvedge {

// What the cores can do at most: chains of multiplications with addition in registers only, on all threads at once.
struct PeakMeasurement {
  InstructionSet set = InstructionSet::plain;
  int threads = 1;
  int lanes = 0;              // floats in a vector
  double clock = 0;           // [Hz], of one core, from a chain of operations of one cycle each
  double flops = 0;           // a second of all threads, best of the rounds; two a multiplication with addition
  double flops_busy = 0;      // a second that one thread really ran: what counts where others use the cores, too
  double share_of_ports = 0;  // of lanes x 2 ports x 2 x clock x threads; a row below 0.85 is void
};
PeakMeasurement measure_peak(InstructionSet, int rounds = 10);

// One network on one graph: best of the rounds.
struct EngineMeasurement {
  int nodes = 0, edges = 0;
  double seconds = 0, operations = 0;
  double busy_seconds = 0;  // that all threads together ran, at least of the rounds
  double bytes = 0;         // latents, sums and products of one run (`infer`), without weights
};
EngineMeasurement measure_engine(const PackedNetwork&, const Graph&, int rounds = 10);

// A piece of cloth for timing: `nodes` numbered row by row, on a grid that closes on itself, so that every node has six
// neighbours and there are six directed edges a node, with key mesh_edge and in the order of the published sets. Random
// features.
Graph grid_graph(const Architecture&, int nodes);

// The network of the figures in docs/results/benchmarks.md: one set of edges, two hidden layers.
Architecture bench_architecture(int width, int steps);

}  // namespace selvedge

#pragma once

#include <string>
#include <vector>

#include "learned/network/engine_bench.hpp"

namespace selvedge {

// One network on one graph, by the engine with the machine's best instruction set.
struct EngineTiming {
  std::string network;
  int width = 0, steps = 0;
  int passes = 1;  // runs of the network a frame; the measurement is of one
  EngineMeasurement run;
};

// Networks beside what the same cores can do at most.
struct EngineTimings {
  PeakMeasurement peak;
  std::vector<EngineTiming> rows;
};

// Shares are void where less than 85 % of lanes x ports x clock was reached: other work used the cores.
bool is_void(const PeakMeasurement&);

// Operations a second over those of the peak: by wall time, and by the time that the threads really ran.
double share_of_peak(const EngineTimings&, const EngineTiming&);
double busy_share_of_peak(const EngineTimings&, const EngineTiming&);

// A network of width 128 with 15 steps on a sheet of `nodes` vertices with six directed edges each, and `small` on a
// sheet of `small_nodes` vertices (the largest square below) with its coarse edges. Features and weights are random.
EngineTimings time_engine(int rounds = 10, int nodes = 5000, int small_nodes = 12000);

// Mesh and coarse edges of a sheet of side x side vertices, as the network's options build them; random features.
Graph sheet_graph(const Architecture&, int side);

// For people.
std::string engine_table(const EngineTimings&);

}  // namespace selvedge

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "learned/gradients/torch_network.hpp"

namespace selvedge {

// Seconds of one optimiser step: forward, backward from a given derivative, Adam. Features and losses are not in it.
struct StepSeconds {
  double wall = 0, busy = 0;  // busy: of all threads together
};

// The kernels and libtorch on the same network and graph, one step each in turn.
struct TrainingTiming {
  std::string network;
  int nodes = 0, edges = 0, threads = 1;
  StepSeconds forward, fused;  // forward: of the fused step
  bool with_torch = false;
  std::string without;  // why there is no libtorch
  StepSeconds torch;
  TorchFacts facts;
  double apart = 0;  // largest difference of the outputs before the first step, relative to the largest output
};

// A sheet of side x side vertices with coarse edges; medians of the rounds. 29 gives 841 vertices and 4,816 mesh edges:
// a T-shirt of 3.5 cm edges has 808 and 4,708.
TrainingTiming time_training(const std::string& preset, int side, int threads, int rounds,
                             const std::filesystem::path& torch_library = torch_library_path());

// For people.
std::string training_table(const std::vector<TrainingTiming>&);

}  // namespace selvedge

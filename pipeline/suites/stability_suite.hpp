#pragma once

#include "pipeline/config/config.hpp"

namespace selvedge {

// What a run of the suite must keep, whatever its scene.
struct StabilityLimits {
  double growth = 0.02;  // energy that nothing accounts for, of the largest kinetic and elastic energy of the run
  double speed = 0.01;   // RMS at the end, of the speed of a fall by the cloth's extent
  int newton = 240;      // iterations a substep; seven solves of at most 32 take 224
  int linear = 1000;     // iterations a Newton iteration: half of what a solve may take
};

// A scene with overrides.
struct StabilityRun {
  std::string name;
  std::vector<std::string> overrides;
  bool brief = false;  // also in the short form
  std::string fault;   // put into the network's weights (spoiled_weights.hpp); empty: none
};

struct StabilityCase {
  std::string name, about;
  std::filesystem::path scene;
  std::vector<StabilityRun> runs;
};

struct StabilitySuite {
  StabilityLimits limits;
  std::vector<StabilityCase> cases;
};

// Throws Error with file, line and key.
StabilitySuite read_stability_suite(const std::filesystem::path&);

}  // namespace selvedge

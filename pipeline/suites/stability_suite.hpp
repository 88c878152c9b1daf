#pragma once

#include "pipeline/config/config.hpp"

namespace selvedge {

// What a run of the suite must keep, whatever its scene. Members are described where keys are bound to them:
// pipeline/suites/stability_suite.cpp.
struct StabilityLimits {
  double growth = 0.02, speed = 0.01;
  int newton = 240, linear = 1000;
};

// A scene with overrides.
struct StabilityRun {
  std::string name;
  std::vector<std::string> overrides;
  bool brief = false;  // also in the short form
  std::string fault;   // put into the network's weights (spoiled_weights.hpp); empty: none
};

struct StabilityCase {
  std::string name;
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

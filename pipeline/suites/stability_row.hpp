#pragma once

#include <string>
#include <vector>

#include "physics/solve/work.hpp"

namespace selvedge {

// What was measured in a run of the suite.
struct StabilityMeasures {
  long nonfinite = 0;      // numbers in states and reports, over all frames
  double energy = 0;       // largest kinetic and elastic energy [J]
  Work work;               // sums over the run [J]
  double unaccounted = 0;  // largest growth of energy beyond the work since any earlier frame [J]
  double end_speed = 0;    // RMS over the last tenth of the run, of the speed of a fall by the cloth's extent
  double newton = 0;       // iterations a substep, worst frame
  double linear = 0;       // iterations a Newton iteration, worst frame
  long jumped = 0;         // obstacles that jumped
};

// The result of one run of the suite.
struct StabilityRow : StabilityMeasures {
  std::string name, run;  // of the case and of the run in it
  std::string stepper;
  int vertices = 0, frames = 0, frames_wanted = 0;
  double seconds = 0;
  bool clean_start = false;
  long pairs = 0;  // intersecting pairs over all frames
  int end_pairs = 0, end_inside = 0;
  double max_stretch = 1;
  int proposed = 0;                   // frames that a hybrid stepper made of a proposal
  std::vector<std::string> notes;     // warnings of the scene
  std::vector<std::string> told;      // what is not held against a bare network, a line each
  std::vector<std::string> failures;  // why it failed, a line each; empty: passed
  bool kept = false;                  // from an earlier call
  bool passed() const { return failures.empty(); }
};

}  // namespace selvedge

#pragma once

#include <functional>
#include <vector>

#include "physics/solve/step_potential.hpp"
#include "physics/steppers/contact_stage.hpp"

namespace selvedge {

// Bounds that a proposed step must keep. On training scenes no conventional step exceeds a third of the bounds of the
// residual, and noise of 3 mm exceeds other bounds first (tests/pipeline/run/long_guard_tables.cpp prints both;
// docs/results/hybrid.md). Members are described where keys are bound to them: pipeline/scene/config_run.cpp.
struct GuardOptions {
  double acceleration = 300, mean_acceleration = 6;
  double change_of_motion = 0.8;
  double stretch = 1.3, stretch_growth = 1.1;
  double energy_growth = 10;
  double patch_acceleration = 60;
  double unexplained = 0.8;
  double imbalance = 1e-3, decrement = 5;
  int patch_size = 20;
  double still = 1e-4;
  double slight = 1;
};

// What the guard measures, in the order of cost.
struct GuardMeasures {
  double acceleration = 0, mean_acceleration = 0;  // [m/s2]
  double change_of_motion = 0;
  double stretch = 1, stretch_before = 1;
  double energy_growth = 0;
  double patch_acceleration = 0;  // [m/s2]
  double unexplained_flight = 0;  // [m/s2]
  double imbalance = 0;           // [m]
  double decrement = 0;
  double in_contact = 0;  // share of free vertices that touch something: left out of the last four measures
};

// Judges proposed steps. Caches, and references to the scene.
struct Guard {
  Guard(const Scene&, const GuardOptions&);
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  const Scene& scene;
  GuardOptions options;
  Eigen::VectorXd masses;
  Elastic elastic;
  std::vector<char> free;
  double unit_energy = 0;         // weight times mean edge [J]
  std::vector<double> stiffness;  // of each vertex at rest [N/m]
  std::vector<int> patch;         // of each vertex; internal forces cancel in a patch's sum
  StepPotential step;
  StepScratch scratch;
};

// Returns 1 for each vertex that touches something, or an empty list. Called only if a proposal passes all cheaper
// tests.
using AskTouching = std::function<std::vector<char>()>;

// Whether the cloth may move from the state to x [m] in dt [s]: `admitted`, or the first reason against it, with the
// cheapest tests first. Tests finite numbers, motion, stretch, elastic energy, and the residual of the incremental
// potential of one implicit Euler step. Contact forces are not known, so that vertices which touch something are left
// out of the residual. `measures` has what was measured before the verdict.
Verdict judge(Guard&, const State& from, const Drive&, double dt, const Points& x, const AskTouching&,
              GuardMeasures& measures);

// The first two tests alone (finite numbers, motion), for callers that process a proposal before it is judged.
Verdict judge_motion(const Guard&, const State& from, double dt, const Points& x, GuardMeasures& measures);

// The test of stretch alone, for callers that leave out what costs an elastic gradient. x must be finite.
Verdict judge_stretch(const Guard&, const State& from, const Points& x, GuardMeasures& measures);

// All measures, even beyond bounds. x must be finite.
GuardMeasures measure(Guard&, const State& from, const Drive&, double dt, const Points& x, const AskTouching&);

// Marks the cloth's vertices that are within twice the contact thickness of anything, in the state or at x.
std::vector<char> touching_vertices(ContactStage&, const State& from, const std::vector<Points>& obstacles,
                                    const Points& x);

// Whether a judged step is free of everything that contact has to prevent: nothing passed through, crosses, or is
// inside a body.
bool is_contact_free(const State& to, const StepReport&);

}  // namespace selvedge

#pragma once

#include <functional>
#include <memory>

#include "physics/scene/stepper.hpp"
#include "physics/steppers/guard.hpp"

namespace selvedge {

enum class HybridMode {
  fallback,   // a proposal that the guard admits becomes the step
  corrected,  // as fallback, after the response to contact has corrected the motion
  response,   // as corrected, judged by motion, audits and energy alone
  rough       // one rough solve begins at the proposal, judged in the same way
};

// Options of the stepper `hybrid`. Members are described where keys are bound to them: pipeline/scene/config_run.cpp.
struct HybridOptions {
  HybridMode mode = HybridMode::corrected;
  GuardOptions guard;
  int longest_stretch = 32;
  int admitted_to_halve = 3;
  bool stop_when_slow = false;
  double extra_time = 0.05;
};

// The steppers inside a hybrid. `proposer` makes steps that are judged; `parent` takes the steps whose proposals are
// refused. `refiner` makes the solves of the mode `rough`; null: the parent does. `hand_over` records a
// step that the proposer has not made in its memory of the state; a proposer that remembers frames needs it in all
// modes but `fallback`.
struct HybridParts {
  std::unique_ptr<Stepper> proposer, parent, refiner = {};
  std::function<void(const State& from, const Drive&, State& to)> hand_over = {};
  std::function<double()> clock = {};  // time so far, for `stop_when_slow` [s]; empty: the machine's clock
};

// A step is the proposer's if the guard admits it, and otherwise the parent's from the same state. No proposal is asked
// for in the first step, if the step starts tangled, if obstacles lag or jump, and for a while after a refusal.
// StepReport::verdict says what happened, and `by` which stepper made the state. A step that starts clean ends clean if
// the parent's does. Keeps a reference to the scene. Throws Error for parts that do not fit together.
std::unique_ptr<Stepper> make_hybrid_stepper(const Scene&, HybridParts, const HybridOptions&);

}  // namespace selvedge

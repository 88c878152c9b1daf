#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "physics/scene/stepper.hpp"
#include "physics/solve/implicit_euler.hpp"
#include "physics/steppers/guard.hpp"

namespace selvedge {

enum class HybridMode {
  fallback,   // a proposal that the guard admits is the step
  corrected,  // its motion goes through the response to contact before
  refined,    // a conventional solve begins at it
  gated,      // as corrected, after a line search of the step's potential from free flight to the proposal
  after_k     // as gated, from where k Newton iterations have come to
};

struct HybridOptions {
  HybridMode mode = HybridMode::corrected;
  GuardOptions guard;
  std::optional<int> newton;  // iterations: k of `after_k`, else 2; of a solve of `refined`, else the solver's own
  int gate_steps = 6;         // places between start and proposal where the potential is asked
  int longest_stretch = 32;   // steps without a proposal, after refusals (proposal_trust.hpp)
  int admitted_to_halve = 3;  // proposals in a row that halve this stretch
  // Stop asking where proposals cost more time than they save. Steps then depend on the clock.
  bool stop_when_slow = false;
  double extra_time = 0.05;  // that proposals may cost, of the time so far
  ImplicitEulerOptions implicit_euler;
};

// Who takes part. The proposer makes steps that are judged; `parent` takes those that are refused. `refiner` makes the
// solves of the mode `refined`, null: the parent does. `hand_over` tells the proposer, in the state's memory, of a step
// that it has not made; a proposer that remembers frames needs it in all modes but `fallback`.
struct HybridParts {
  std::unique_ptr<Stepper> proposer, parent, refiner = {};
  std::function<void(const State& from, State& to)> hand_over = {};
  std::function<double()> clock = {};  // time so far, of the rule `stop_when_slow`; none: of the machine [s]
};

// A step is the proposer's where the guard admits it, and otherwise the parent's from the same state. No proposal is
// asked for where the step starts tangled, in the first step, where obstacles lag or jump, and for a while after one
// was refused. StepReport::verdict says what happened, and `by` who made the state. A step that starts clean ends clean
// wherever the parent's do.
// Keeps a reference to the scene. Throws Error for parts that do not go together.
std::unique_ptr<Stepper> make_hybrid_stepper(const Scene&, HybridParts, const HybridOptions&);

}  // namespace selvedge

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "physics/scene/features.hpp"
#include "physics/scene/stepper.hpp"
#include "pipeline/config/config.hpp"

namespace selvedge {

struct Setup;

// What a kind of stepper does with the network of run.learned.
enum class NetworkUse {
  none,
  alone,   // its frames are what the network makes
  guarded  // the network proposes, and another stepper decides
};

// A kind of stepper that a scene file names by `run.stepper`: all that differs from kind to kind.
struct StepperKind {
  std::string name;
  // The table of the key run.<name>; null: the kind has no options, or they stand in run_options(). It bears the kind's
  // name and must outlive every setup that is read with it.
  const Section* options = nullptr;
  // The maker of bare steppers (decorated_stepper.hpp) of a scene; `given` is the section as the file has it.
  std::function<MakeStepper(const Setup&, const Config& given)> maker = {};
  NetworkUse network = NetworkUse::none;
  // It reads run.learned.weights though it runs no network.
  bool coefficients = false;
  // Its steps without contact are the minimisers that the options of `solver` describe.
  bool minimises = false;
  // Throws Error for what the scene file says and the kind does not take; empty: it takes all.
  std::function<void(const Config& scene)> check = {};
  // What it adds to a scene's plan. Throws Error where it does not take the scene; empty: nothing.
  std::function<std::vector<PlanLine>(const Setup&)> plan = {};
};

// The kinds that scene files may name.
class Kinds {
 public:
  void add(StepperKind);                                   // throws Error for a name that is taken
  const StepperKind* find(const std::string& name) const;  // null: none
  const std::vector<StepperKind>& all() const { return kinds_; }
  std::vector<std::string> names() const;

 private:
  std::vector<StepperKind> kinds_;
};

// The kinds of the program (known_kinds.cpp).
Kinds known_kinds();

}  // namespace selvedge

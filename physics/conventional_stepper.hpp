#pragma once

#include <memory>
#include <optional>

#include "physics/implicit_euler.hpp"
#include "physics/stepper.hpp"

namespace selvedge {

struct ConventionalOptions {
  std::optional<int> substeps;  // nothing: chosen each frame from the speed
  int max_substeps = 12;
  ImplicitEulerOptions implicit_euler;
};

// Implicit Euler, then contact in Bridson's order, then the audit. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_conventional_stepper(const Scene&, const ConventionalOptions&);

}  // namespace selvedge

#pragma once

#include <memory>
#include <optional>

#include "collision/contact/resolve_options.hpp"
#include "physics/scene/stepper.hpp"
#include "physics/solve/implicit_euler.hpp"
#include "physics/steppers/substep_options.hpp"

namespace selvedge {

// bdf2: of second order where nothing touches; implicit Euler, without a history, for a substep in which something
// does or before which pins jump, for the first one after it, and where the substep's length has changed.
enum class Integrator { implicit_euler, bdf2 };

struct ConventionalOptions {
  std::optional<int> substeps;      // nothing: chosen each frame from the speed
  std::optional<int> min_substeps;  // nothing: least_substeps
  int max_substeps = 12;
  Integrator integrator = Integrator::implicit_euler;
  ImplicitEulerOptions implicit_euler;
  SubstepOptions substep;
  ResolveOptions resolve;  // thickness, separation and friction are those of the scene
};

// Implicit Euler or BDF2, then contact in Bridson's order, then the audit. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_conventional_stepper(const Scene&, const ConventionalOptions&);

}  // namespace selvedge

#pragma once

#include <memory>
#include <optional>

#include "collision/contact/resolve_options.hpp"
#include "physics/scene/stepper.hpp"
#include "physics/solve/implicit_euler.hpp"
#include "physics/steppers/substep_options.hpp"

namespace selvedge {

// bdf2 is of second order where contact does not begin, vertex by vertex (vertex_history.hpp). All of the cloth is
// implicit Euler's in a substep in which pins jump, in one that is taken again because its impact zones did not
// converge, and where contact leaves pairs alone.
enum class Integrator { implicit_euler, bdf2 };

// Where the first solve of a step begins. inertia: where the cloth goes as it moves. carried: carried_guess
// (carried_stepper.hpp), if the incremental potential is lower there.
enum class FirstGuess { inertia, carried };

// Options of the stepper `conventional`, which sets thickness, separation and friction in `resolve` to those of the
// scene. Members are described where keys are bound to them: pipeline/scene/config_run.cpp,
// pipeline/scene/config_solver.cpp.
struct ConventionalOptions {
  std::optional<int> substeps, min_substeps;
  int max_substeps = 12;
  Integrator integrator = Integrator::implicit_euler;
  FirstGuess guess = FirstGuess::inertia;
  ImplicitEulerOptions implicit_euler;
  SubstepOptions substep;
  ResolveOptions resolve;
  bool contact_forces = false;
  const char* name = "conventional";  // of the stepper, in reports
};

// Implicit Euler or BDF2, then the response to contact in Bridson's order. A step whose response spends its budget is
// taken again in shorter substeps. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_conventional_stepper(const Scene&, const ConventionalOptions&);

}  // namespace selvedge

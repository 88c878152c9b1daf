#include "pipeline/compare/algebraic_error.hpp"

#include "physics/energies/measures.hpp"
#include "physics/linear/cholesky.hpp"
#include "physics/solve/bdf2.hpp"
#include "physics/steppers/decorated_stepper.hpp"

namespace selvedge {
namespace {

ImplicitEulerOptions tightened(ImplicitEulerOptions options) {
  options.velocity_tolerance = 1e-10;
  options.relative_tolerance = 0;
  options.max_newton = 100;
  options.linear_tolerance = 1e-10;
  options.max_linear = 100000;
  if (Cholesky::available()) options.linear_solver = LinearSolver::cholmod;
  return options;
}

// False where the step meets contact or is rejected.
bool free_step(Stepper& stepper, const State& from, const Drive& drive, double dt, State& to) {
  const StepReport report = stepper.step(from, drive, dt, to);
  const CollisionReport& collision = report.collision;
  return report.status == StepStatus::accepted && collision.contacts + collision.impulses + collision.zones == 0;
}

}  // namespace

std::optional<AlgebraicError> algebraic_error(const Setup& setup, const State& start, double dt) {
  if (!setup.kind.minimises) return {};
  ConventionalOptions single = setup.run.conventional;
  single.substeps = 1;
  const auto stepper = make_recovering_conventional_stepper(setup.scene, single);
  State from = start, to;
  forget_motion(from.memory);
  if (single.integrator == Integrator::bdf2) {
    if (!free_step(*stepper, from, setup.drive_at(from.time + dt), dt, to) || step_history(to).h != dt) return {};
    from = to;
  }
  const Drive drive = setup.drive_at(from.time + dt);
  if (!free_step(*stepper, from, drive, dt, to)) return {};

  const StepHistory history = step_history(from);
  const StepStart base = history.h > 0 ? bdf2_start(history, from.x, from.v) : StepStart{dt, from.x, from.v};
  ImplicitEuler reference(setup.scene, tightened(single.implicit_euler));
  Points minimiser = to.x;
  const StepProblem problem{base.h, &base.x, &base.v, &drive.pins, drive.acceleration, drive.wind, {}};
  AlgebraicError result;
  result.reference_converged = reference.solve(problem, minimiser).converged;
  const double motion = root_mean_square(minimiser - from.x);
  if (!(motion > 0)) return result;
  result.error = root_mean_square(to.x - minimiser) / motion;
  result.largest = (to.x - minimiser).rowwise().norm().maxCoeff() / motion;
  return result;
}

}  // namespace selvedge

#include "pipeline/algebraic_error.hpp"

#include <algorithm>
#include <cmath>

#include "physics/conventional_stepper.hpp"

namespace selvedge {
namespace {

double rms(const Points& difference) {
  return std::sqrt(difference.squaredNorm() / std::max<double>(1, static_cast<double>(difference.rows())));
}

ImplicitEulerOptions tightened(ImplicitEulerOptions options) {
  options.velocity_tolerance = 1e-10;
  options.relative_tolerance = 0;
  options.max_newton = 100;
  options.linear_tolerance = 1e-10;
  options.max_linear = 100000;
  return options;
}

}  // namespace

std::optional<AlgebraicError> algebraic_error(const Setup& setup, const State& from, double dt) {
  ConventionalOptions single = setup.run.conventional;
  single.substeps = 1;
  const Drive drive = setup.drive_at(from.time + dt);
  State to;
  const StepReport report = make_conventional_stepper(setup.scene, single)->step(from, drive, dt, to);
  const CollisionReport& collision = report.collision;
  if (report.status != StepStatus::accepted || collision.contacts + collision.impulses + collision.zones > 0) return {};

  ImplicitEuler reference(setup.scene, tightened(single.implicit_euler));
  Points minimiser = to.x;
  const StepProblem problem{dt, &from.x, &from.v, &drive.pins, drive.acceleration, drive.wind, {}};
  AlgebraicError result;
  result.reference_converged = reference.solve(problem, minimiser).converged;
  result.motion = rms(minimiser - from.x);
  result.error = result.motion > 0 ? rms(to.x - minimiser) / result.motion : 0;
  return result;
}

}  // namespace selvedge

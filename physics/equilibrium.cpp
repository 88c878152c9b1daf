#include "physics/equilibrium.hpp"
#include <cstdio>
#include <cstdlib>

#include <algorithm>
#include <cmath>

#include "physics/cholesky.hpp"

namespace selvedge {
namespace {

constexpr double first_step = 0.3;  // in the time in which the load alone would move the cloth by its size
constexpr double growth = 2, longest_step = 300;

Points pins_at(const Scene& scene, const Points& x) {
  Points pins(static_cast<Eigen::Index>(scene.pins.size()), 3);
  for (std::size_t p = 0; p < scene.pins.size(); ++p) pins.row(static_cast<Eigen::Index>(p)) = x.row(scene.pins[p]);
  return pins;
}

}  // namespace

ImplicitEulerOptions to_the_end() {
  ImplicitEulerOptions options;
  options.velocity_tolerance = 1e-8;
  options.max_newton = 40;
  options.linear_solver = Cholesky::available() ? LinearSolver::cholmod : LinearSolver::automatic;
  options.linear_tolerance = 1e-4;
  options.max_linear = 20000;
  return options;
}

double weight_norm(const Scene& scene, const Vec3& acceleration) {
  Eigen::VectorXd masses = lumped_masses(scene);
  for (const int pin : scene.pins) masses[pin] = 0;
  return masses.norm() * acceleration.norm();
}

Equilibrium settle(const Scene& scene, const Points& start, const StaticLoad& load, const EquilibriumOptions& options) {
  ImplicitEuler solver(scene, options.implicit_euler);
  const Points rest_velocity = Points::Zero(start.rows(), 3), pins = pins_at(scene, start);
  const double extent = (start.colwise().maxCoeff() - start.colwise().minCoeff()).norm();
  const double typical = std::sqrt(extent * solver.masses().norm() / load.size);
  Equilibrium result{start, false, 0, 0, 0};
  double step = first_step;
  for (; result.steps < options.max_steps; ++result.steps) {
    const Points from = result.x;
    StepProblem problem;
    problem.h = step * typical;
    problem.x0 = &from;
    problem.v0 = &rest_velocity;
    problem.pins = &pins;
    problem.acceleration = load.acceleration;
    problem.added = load.added;
    // At the start of a step from rest the potential's gradient is the imbalance of all forces.
    result.residual = solver.gradient(problem, from).norm() / load.size;
    result.converged = result.residual <= options.tolerance;
    if (result.converged) break;
    const NewtonReport newton = solver.solve(problem, result.x);
    result.iterations += newton.iterations;
    if (!newton.finite || !result.x.allFinite()) {
      result.x = from;
      break;
    }
    if (getenv("DBG")) printf("h %g res %g its %d lin %d conv %d newres %g\n", problem.h, result.residual, newton.iterations, newton.linear_iterations, newton.converged, newton.residual);
    if (newton.converged) step = std::min(step * growth, longest_step);
  }
  return result;
}

}  // namespace selvedge

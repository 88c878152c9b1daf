#include "physics/solve/equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/box_diagonal.hpp"
#include "physics/linear/cholesky.hpp"

namespace selvedge {
namespace {

constexpr double first_step = 0.3;  // in units of the time in which the load moves the cloth by its size
constexpr double growth = 3, long_step = 100, longest_step = 300;

}  // namespace

ImplicitEulerOptions to_the_end() {
  ImplicitEulerOptions options;
  options.velocity_tolerance = 1e-6;
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
  const Points rest_velocity = Points::Zero(start.rows(), 3), pins = start(scene.pins, Eigen::all);
  const double extent = box_diagonal(start);
  const double typical = std::sqrt(extent * solver.masses().norm() / load.size);
  Equilibrium result;
  result.x = start;
  double step = first_step;
  while (!result.converged && result.steps < options.max_steps) {
    const Points from = result.x;
    StepProblem problem;
    problem.h = step * typical;
    problem.x0 = &from;
    problem.v0 = &rest_velocity;
    problem.pins = &pins;
    problem.acceleration = load.acceleration;
    problem.added = load.added;
    const NewtonReport newton = solver.solve(problem, result.x);
    ++result.steps;
    result.iterations += newton.iterations;
    if (!newton.finite || !result.x.allFinite()) {
      result.x = from;
      return result;
    }
    result.moved = (result.x - from).norm() / std::sqrt(static_cast<double>(from.rows())) / extent;
    const bool still = result.moved < options.tolerance;
    if (still && step >= long_step) {
      // At the start of a step from rest the potential's gradient is the imbalance of all forces.
      problem.x0 = &result.x;
      result.residual = solver.gradient(problem, result.x).norm() / load.size;
      result.converged = true;
    }
    if (newton.converged || still) step = std::min(step * growth, longest_step);
  }
  return result;
}

}  // namespace selvedge

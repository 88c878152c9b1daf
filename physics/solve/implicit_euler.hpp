#pragma once

#include <memory>

#include "physics/linear/linear_system.hpp"
#include "physics/scene/scene.hpp"
#include "physics/solve/step_problem.hpp"

namespace selvedge {

struct ImplicitEulerOptions {
  double velocity_tolerance = 1.7e-3;  // Newton ends when the RMS of its displacement is below this times the time
                                       // step [m/s],
  double relative_tolerance = 1.7e-3;  // or below this part of the RMS motion in the step
  int max_newton = 8;
  LinearSolver linear_solver = LinearSolver::automatic;
  double linear_tolerance = 0.25;  // of PCG in a Newton iteration, in the norm of its preconditioner
  int max_linear = 2000;
  double slip_speed = 2e-3;  // below it lagged friction is viscous [m/s]
};

struct NewtonReport {
  bool converged = false;
  bool finite = true;
  int iterations = 0, linear_iterations = 0;
  int coarse_builds = 0;  // of multigrid's coarse levels
};

// Minimises the incremental potential
//   E(x) = sum_i m_i |x_i - y_i|^2 / (2 h^2) + membrane + bending + springs + damping + wind + contact
//          + friction + added,
//   y = x0 + h v0 + h^2 acceleration,
// with pins held exactly, by projected Newton with line search. Holds caches only (patterns, factors, scratch).
class ImplicitEuler {
 public:
  ImplicitEuler(const Scene&, const ImplicitEulerOptions&);  // keeps a reference to the scene
  ~ImplicitEuler();
  // x: first guess in, minimiser out.
  NewtonReport solve(const StepProblem&, Points& x);
  double potential(const StepProblem&, const Points& x);
  Points gradient(const StepProblem&, const Points& x);   // zero rows at pins
  double imbalance(const StepProblem&, const Points& x);  // largest force on a free vertex [N]
  LinearSolver chosen_solver() const;
  const Eigen::VectorXd& masses() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvedge

#pragma once

#include <memory>

#include "physics/linear/linear_system.hpp"
#include "physics/scene/scene.hpp"
#include "physics/solve/step_problem.hpp"

namespace selvedge {

struct Elastic;  // physics/solve/assembly.hpp

// When Newton uses longer steps, exact Hessians and more iterations. Members are described where keys are bound to
// them: pipeline/scene/config_solver.cpp.
struct NewtonOptions {
  int exact_from = 3;

  // A longer step is tried if the change of the potential over its linear prediction is larger. Exact quadratics have
  // 0.5.
  static constexpr double nearly_linear = 0.7;
  // No step is longer than this many Newton steps.
  static constexpr double longest_step = 16;
  // Cloth is stiff if its mean stiffness is this many times its inertia over h^2.
  static constexpr double stiff = 1e5;
  // Stiff cloth is solved until a Newton step gains no more energy than a motion of this many times the tolerance.
  static constexpr double stiff_allowance = 4;
  // Any cloth with contact is solved until a Newton step gains less than this part of the potential.
  static constexpr double far_energy = 0.1;
  // These two rules take at most this many times max_newton iterations.
  static constexpr int more_iterations = 8;
};

// When a solve by Newton's method ends, and how it solves linear systems. Members are described where keys are bound to
// them: pipeline/scene/config_solver.cpp.
struct ImplicitEulerOptions {
  double velocity_tolerance = 1.7e-3, relative_tolerance = 1.7e-3;
  int max_newton = 8;
  LinearSolver linear_solver = LinearSolver::automatic;
  double linear_tolerance = 0.25;
  int max_linear = 2000;
  int max_newton_step = 1000;
  double slip_speed = 2e-3;
  // A step counts as not converged if StepReport::unsolved, an RMS distance, is larger [m].
  double tolerated_error = 5e-4;
  NewtonOptions newton;
};

struct NewtonReport {
  bool converged = false;
  bool finite = true;
  bool stopped = false;  // by the problem's flag: x is not a minimiser
  int iterations = 0, linear_iterations = 0;
  int coarse_builds = 0;  // of multigrid's coarse levels
  double left = 0;        // bound of the RMS distance from the minimiser, from the last iteration [m]
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
  Points gradient(const StepProblem&, const Points& x);  // zero rows at pins [N]
  LinearSolver chosen_solver() const;
  const Eigen::VectorXd& masses() const;  // lumped [kg]
  const Elastic& elastic() const;         // the elements of the scene

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvedge

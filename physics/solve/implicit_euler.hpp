#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "physics/energies/contact_energy.hpp"
#include "physics/linear/linear_system.hpp"
#include "physics/scene/scene.hpp"

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
};

// A term of the potential that this solver knows nothing of. It may be anything that has a value; where it jumps or has
// kinks the line search still holds Newton to what sinks.
struct AddedTerm {
  std::function<double(const Points& x)> value;  // [J]
  // Adds a gradient [N], and blocks whose sum is a positive semidefinite stand-in for the second derivative.
  std::function<void(const Points& x, Points& gradient, std::vector<ContactBlock>& blocks)> add_derivatives;
};

// One step's data. Everything is over the cloth's joint numbering.
struct StepProblem {
  double h = 0;                // [s]
  const Points* x0 = nullptr;  // positions and velocities at the step's start
  const Points* v0 = nullptr;
  const Points* pins = nullptr;  // targets, one row a Scene::pins entry
  Vec3 acceleration = Vec3::Zero();
  Vec3 wind = Vec3::Zero();
  std::span<const ContactTerm> contacts;
  double roughness = 1;  // times the tolerance: for a solve that only feeds another one
  const AddedTerm* added = nullptr;
  double patience = 1;   // times the most iterations, for a solve that another one goes on from
  bool goes_on = false;  // from where an earlier solve of the same step ended: no other first guess is weighed
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

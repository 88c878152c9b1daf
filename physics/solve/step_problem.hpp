#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "collision/geometry/points.hpp"
#include "collision/geometry/stop_flag.hpp"
#include "physics/energies/contact_energy.hpp"
#include "physics/linear/linear_system.hpp"

namespace selvedge {

// A term of the potential that implicit Euler knows nothing of. It may be anything that has a value; where it jumps or
// has kinks the line search still holds Newton to what sinks.
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
  double tolerance_scale = 1;  // of a solve that only feeds another one
  const AddedTerm* added = nullptr;
  double iteration_scale = 1;  // of the most iterations, of a solve that another one goes on from
  bool warm_start = false;     // x is where an earlier solve of the same step ended: no other first guess is weighed
  const StopFlag* stop = nullptr;                         // asked once an iteration
  int most_iterations = std::numeric_limits<int>::max();  // whatever is left to be done then
};

}  // namespace selvedge

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

// A term of the potential that a caller adds. It may jump or have kinks: the line search still accepts only steps that
// lower the potential.
struct AddedTerm {
  std::function<double(const Points& x)> value;  // [J]
  // Adds a gradient [N], and blocks whose sum is a positive semidefinite approximation of the second derivative.
  std::function<void(const Points& x, Points& gradient, std::vector<ContactBlock>& blocks)> add_derivatives;
};

// Where the inertia of each vertex starts: with v1 the velocity at the step's end,
//   v1 = (x1 - x) / position_h,   m (v1 - v) / velocity_h = forces(x1).
struct VertexStarts {
  std::vector<double> position_h, velocity_h;  // [s]
  Points x, v;
};

// The data of one step, in the cloth's joint numbering.
struct StepProblem {
  double h = 0;                // [s]
  const Points* x0 = nullptr;  // positions and velocities at the step's start
  const Points* v0 = nullptr;
  const Points* pins = nullptr;  // targets, one row a Scene::pins entry
  Vec3 acceleration = Vec3::Zero();
  Vec3 wind = Vec3::Zero();
  std::span<const ContactTerm> contacts;
  double tolerance_scale = 1;  // of a solve whose result only feeds another one
  const AddedTerm* added = nullptr;
  double iteration_scale = 1;      // of the most iterations, for a solve that another one continues
  bool warm_start = false;         // x is the end of an earlier solve of the same step: no other first guess is tried
  const StopFlag* stop = nullptr;  // asked in each iteration
  int most_iterations = std::numeric_limits<int>::max();  // a hard limit
  const VertexStarts* starts = nullptr;                   // of inertia alone; null: h, x0 and v0
};

}  // namespace selvedge

#pragma once

#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/solve/step_problem.hpp"

namespace selvedge {

// A step of implicit Euler gives cloth the angular momentum h sum m v1 x v0 without any force, where v0 and v1 are the
// velocities at its ends. It damps swinging and turning unequally: a swinging motion loses its angular momentum, a
// turning one keeps it. So a sheet on one pin that began without angular momentum ends up turning. Where pins leave a
// part of the cloth free to turn, this torque is removed, except the damping of a rigid rotation: a share w^2 h each
// second.
class EulerTorque {
 public:
  explicit EulerTorque(const Scene&);
  // Removes this torque from the velocities v1 [m/s] at the step's end x1 [m], and the torque of `unbalanced`, the
  // forces that the solve left [N] (its potential's gradient). Parts turn about the vertical through their pins, if
  // their pins are on one vertical all the time. Without gravity, and in wind, which turns cloth itself, nothing is
  // changed. No part gets more angular momentum than it had at one of the step's ends.
  void take_back(const StepProblem&, const Points& x1, const Points& unbalanced, Points& v1) const;

 private:
  struct Part {
    std::vector<int> free, pins;
  };
  Eigen::VectorXd masses_;
  std::vector<Part> parts_;  // connected by triangles or springs, with pins
};

}  // namespace selvedge

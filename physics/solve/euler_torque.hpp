#pragma once

#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/solve/step_problem.hpp"

namespace selvedge {

// A step of implicit Euler gives cloth the angular momentum h sum m v1 x v0 that no force explains, v0 and v1 the
// velocities at its ends. It damps the parts of a motion unequally: what swings loses its angular momentum, what turns
// keeps its own, and a sheet on one pin that began with none is left turning. Where pins leave a part of the cloth free
// to turn, that torque is taken back, but for what it takes from a rigid rotation: w^2 h of it a second.
class EulerTorque {
 public:
  explicit EulerTorque(const Scene&);
  // Takes it from the velocities v1 [m/s] with which the step ended in x1 [m], and with it the torque of the forces
  // that the solve left unbalanced [N], its potential's gradient. Parts turn about the vertical through their pins,
  // where these lie on one all the time. Without gravity, and in wind, which turns cloth itself, nothing is changed. No
  // part has more angular momentum than at one of the step's ends.
  void take_back(const StepProblem&, const Points& x1, const Points& unbalanced, Points& v1) const;

 private:
  struct Part {
    std::vector<int> free, pins;
  };
  Eigen::VectorXd masses_;
  std::vector<Part> parts_;  // what holds together, by triangles or springs, and has pins
};

}  // namespace selvedge

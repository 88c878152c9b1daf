#pragma once

#include <memory>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"
#include "physics/steppers/conventional_stepper.hpp"

namespace selvedge {

// The incremental potential of a frame as a function of where the cloth ends: what the conventional stepper minimises
// in its first solve, if it makes the frame in one substep (ImplicitEuler). A tangled start is parted before, as the
// recovering stepper does it. Keeps a reference to the scene.
class FramePotential {
 public:
  explicit FramePotential(const Scene&, const ConventionalOptions& = {});
  ~FramePotential();

  // Begins the frame of dt [s] from the state: makes its contact terms, without friction until `lag`. Returns false if
  // the positions are not finite, or too many pairs are near each other. It depends on its arguments alone.
  bool begin(const State& from, const Drive&, double dt);
  // Bounds friction by the normal forces that contact has where the cloth is at x [m].
  void lag(const Points& x);
  // The potential with the cloth at x [J]. Adds the derivative, which is 0 for pins, where `gradient` is not null [N].
  double at(const Points& x, Points* gradient);
  int contacts() const;  // terms

 private:
  class Probe;
  Probe* probe_;                      // owned by stepper_
  std::unique_ptr<Stepper> stepper_;  // parts tangled starts, and hands them to the probe
};

}  // namespace selvedge

#pragma once

#include <optional>

#include "physics/solve/work.hpp"

namespace selvedge {

// The change of the cloth's energy in a step [J]: kinetic, elastic and of gravity.
struct EnergyGain {
  double gain = 0;
  double work = 0;       // bound of the work of pins, obstacles and wind (work.hpp); 0 where it is not needed
  double nowhere = 0;    // gain beyond `work`, in this and earlier steps, minus losses since
  double tolerated = 0;  // how much of `nowhere`
  bool from_nowhere() const { return !(gain <= work) && !(nowhere <= tolerated); }
};

// Judges the energy of a scene step by step. Small unexplained gains of several steps are judged together:
// State::memory holds their sum. Holds caches, and a reference to the scene.
class EnergyBalance {
 public:
  // Without the forces that a stepper with these traits ignores.
  explicit EnergyBalance(const Scene&, const StepperTraits& = {});
  // With the scene's elements as the stepper holds them already; refers to them.
  EnergyBalance(const Scene&, const Elastic&);
  EnergyBalance(const EnergyBalance&) = delete;
  EnergyBalance& operator=(const EnergyBalance&) = delete;
  // Judges an accepted step; positions and velocities must be finite. The memory of `to` gets the sum of unexplained
  // gains; after a step that is `from_nowhere` the sum is 0 again.
  EnergyGain operator()(const State& from, const Drive&, State& to);
  // The same for a step whose end no solver has balanced: the work is that of WorkBound::of_world, whose `listed` this
  // is.
  EnergyGain of_proposal(const State& from, const Drive&, State& to, PathPairs& listed);

  // Sets the doubt `energy_gain` of an accepted step that is `from_nowhere`.
  void label(const State& from, const Drive&, State& to, StepReport&);

 private:
  Energies energies_of(const State&, const Vec3& acceleration);
  template <class WorkOf>
  EnergyGain judge(const State& from, const Drive&, State& to, WorkOf&&);
  WorkBound& work_bound();

  std::optional<Scene> reduced_;  // without the forces that the stepper ignores; absent if it ignores none
  const Scene& scene_;            // that, or the scene itself
  std::optional<Elastic> own_;    // absent where the stepper holds the elements
  const Elastic& elastic_;        // those, or the stepper's
  Eigen::VectorXd masses_;        // lumped [kg]
  double edge_length_;
  std::optional<WorkBound> work_;  // made when first needed
  struct Known {
    Points x, v;
    Vec3 acceleration = Vec3::Zero();
    Energies energies;
  } last_;  // the energies computed last
};

}  // namespace selvedge

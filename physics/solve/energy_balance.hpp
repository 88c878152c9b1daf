#pragma once

#include <optional>

#include "physics/solve/work.hpp"

namespace selvedge {

// What a step did to the energy of the cloth [J]: kinetic, elastic and of gravity.
struct EnergyGain {
  double gain = 0;
  double work = 0;       // bound of what pins, obstacles and wind gave (work.hpp); 0 where it does not matter
  double nowhere = 0;    // gained beyond that, in this step and those before it, less what was lost since
  double tolerated = 0;  // of that
  bool from_nowhere() const { return !(gain <= work) && !(nowhere <= tolerated); }
};

// Judges the energy of a scene step by step. Steps that each gain a little from nowhere are judged together:
// State::memory holds the sum of what they gained. Forces that a stepper with these traits ignores are left out. Holds
// caches.
class EnergyBalance {
 public:
  explicit EnergyBalance(const Scene&, const StepperTraits& = {});
  EnergyBalance(const EnergyBalance&) = delete;
  EnergyBalance& operator=(const EnergyBalance&) = delete;
  // Of a step that is taken; positions and velocities must be finite. `to` remembers what was gained from nowhere;
  // after a step whose energy comes from nowhere that sum begins at 0.
  EnergyGain operator()(const State& from, const Drive&, State& to);

  // Sets the doubt `energy_gain` of an accepted step whose energy comes from nowhere.
  void label(const State& from, const Drive&, State& to, StepReport&);

 private:
  Energies energies_of(const State&, const Vec3& acceleration);
  double work_of(const State& from, const State& to, const Drive&);

  Scene scene_;  // as the stepper has it
  EnergyTerms terms_;
  double edge_length_;
  std::optional<WorkBound> work_;  // made when first needed
  struct Known {
    Points x, v;
    Vec3 acceleration = Vec3::Zero();
    Energies energies;
  } last_;  // energies that were asked for last
};

}  // namespace selvedge

#include "physics/scene/stepper.hpp"

#include <cmath>

namespace selvedge {

PhaseTimes& PhaseTimes::operator+=(const PhaseTimes& other) {
  for (const auto phase :
       {&PhaseTimes::solve, &PhaseTimes::broad_phase, &PhaseTimes::ccd, &PhaseTimes::response, &PhaseTimes::audit,
        &PhaseTimes::graph, &PhaseTimes::network, &PhaseTimes::guard, &PhaseTimes::body})
    this->*phase += other.*phase;
  return *this;
}

StepCounts& StepCounts::operator+=(const StepCounts& other) {
  solves += other.solves;
  coarse_builds += other.coarse_builds;
  searches += other.searches;
  candidates += other.candidates;
  audits += other.audits;
  swept += other.swept;
  projected += other.projected;
  return *this;
}

constexpr double longest_step = 1e9;  // [s], the bound of scene_numbers.hpp

bool StepperTraits::accepts(double dt) const {
  return dt > 0 && dt <= longest_step && (!only_dt || std::abs(dt - *only_dt) <= 1e-9);
}

}  // namespace selvedge

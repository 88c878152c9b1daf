#include "physics/scene/stepper.hpp"

#include <cmath>

namespace selvedge {

PhaseTimes& PhaseTimes::operator+=(const PhaseTimes& other) {
  solve += other.solve;
  broad_phase += other.broad_phase;
  ccd += other.ccd;
  response += other.response;
  audit += other.audit;
  graph += other.graph;
  network += other.network;
  guard += other.guard;
  body += other.body;
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

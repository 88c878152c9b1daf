#include "physics/solve/energy_balance.hpp"

#include <algorithm>

#include "physics/scene/features.hpp"

namespace selvedge {
namespace {

constexpr const char* block = "energy.from_nowhere";
constexpr double tolerated_part = 0.3;  // of the unit of energy; demo, walks, wind and piles have at most 0.2
constexpr double slight = 0.05;         // of it: smaller gains in driven scenes are not compared with the work
constexpr double earth = 9.81;          // for the unit of energy without gravity [m/s2]

double gained_before(const State& state) {
  const MemoryRows* rows = find_rows(state.memory, block, 1);
  return rows && rows->cols() == 1 ? (*rows)(0, 0) : 0;
}

void remember(double nowhere, State& state) {
  Memory blocks;
  if (nowhere > 0) blocks.push_back({block, MemoryRows::Constant(1, 1, nowhere)});
  replace_blocks("energy", std::move(blocks), state.memory);
}

// Whether the world may have done work: a pin or an obstacle moved, or there is wind.
bool is_driven(const Scene& scene, const State& from, const State& to, const Drive& drive) {
  return !drive.wind.isZero(0) || from.obstacles != to.obstacles ||
         std::ranges::any_of(scene.pins, [&](int pin) { return from.x.row(pin) != to.x.row(pin); });
}

}  // namespace

EnergyBalance::EnergyBalance(const Scene& scene, const StepperTraits& traits)
    : reduced_(traits.ignores.empty() ? std::nullopt : std::optional<Scene>(without_ignored(scene, traits))),
      scene_(reduced_ ? *reduced_ : scene),
      own_(make_elastic(scene_)),
      elastic_(*own_),
      masses_(lumped_masses(scene_)),
      edge_length_(mean_edge_length(scene_)) {}

EnergyBalance::EnergyBalance(const Scene& scene, const Elastic& elastic)
    : scene_(scene), elastic_(elastic), masses_(lumped_masses(scene)), edge_length_(mean_edge_length(scene)) {}

// Caches the last result: a step usually starts with the state that the step before ended with.
Energies EnergyBalance::energies_of(const State& state, const Vec3& acceleration) {
  const bool known = last_.x.rows() == state.x.rows() && last_.v.rows() == state.v.rows() && last_.x == state.x &&
                     last_.v == state.v && last_.acceleration == acceleration;
  if (!known)
    last_ = {state.x, state.v, acceleration,
             energies(scene_, energy_elements(elastic_, masses_), state.x, state.v, acceleration)};
  return last_.energies;
}

WorkBound& EnergyBalance::work_bound() {
  if (!work_) work_.emplace(scene_, elastic_);
  return *work_;
}

// `work_of` bounds the work of the step.
template <class WorkOf>
EnergyGain EnergyBalance::judge(const State& from, const Drive& drive, State& to, WorkOf&& work_of) {
  const Energies before = energies_of(from, drive.acceleration), after = energies_of(to, drive.acceleration);
  const double gained = gained_before(from), weight = masses_.sum() * std::max(earth, drive.acceleration.norm());
  const double unit = std::max(0.0, before.total() - before.gravity - gained) + weight * edge_length_;
  EnergyGain found{.gain = after.total() - before.total(), .tolerated = tolerated_part * unit};
  const bool driven = is_driven(scene_, from, to, drive);
  if (driven && found.gain > 0) {
    found.work = found.gain;
    if (found.gain > slight * unit) {
      const Work work = work_of();
      found.work = work.pins + work.obstacles + work.wind;
    }
  }
  const double nowhere = gained + (found.gain > 0 ? std::max(found.gain - found.work, 0.0) : found.gain);
  found.nowhere = nowhere < 0 ? 0 : nowhere;  // NaN stays NaN
  remember(found.from_nowhere() ? 0 : found.nowhere, to);
  return found;
}

EnergyGain EnergyBalance::operator()(const State& from, const Drive& drive, State& to) {
  return judge(from, drive, to, [&] { return work_bound()(from, to, drive); });
}

EnergyGain EnergyBalance::of_proposal(const State& from, const Drive& drive, State& to, PathPairs& listed) {
  return judge(from, drive, to, [&] { return work_bound().of_world(from, to, drive, &listed); });
}

void EnergyBalance::label(const State& from, const Drive& drive, State& to, StepReport& report) {
  if (report.status != StepStatus::accepted) return;
  report.doubts.energy_gain = (*this)(from, drive, to).from_nowhere();
}

}  // namespace selvedge

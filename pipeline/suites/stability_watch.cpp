#include "pipeline/suites/stability_watch.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/box_diagonal.hpp"
#include "physics/scene/features.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {
namespace {

constexpr double end_part = 0.1;  // of the run, in which it must rest

long count_nonfinite(const Points& points) { return points.size() - points.array().isFinite().count(); }

}  // namespace

StabilityWatch::StabilityWatch(const Setup& setup, const State& start, const StepperTraits& stepper)
    : setup_(setup),
      scene_(without_ignored(setup.scene, stepper)),
      elastic_(make_elastic(scene_)),
      masses_(lumped_masses(scene_)),
      bound_(scene_, elastic_),
      before_(start) {
  const Vec3 gravity = setup.drive_at(0).acceleration;
  lowest_ = energy(before_, gravity);
}

// Total energy; notes the largest without gravity.
double StabilityWatch::energy(const State& state, const Vec3& acceleration) {
  const Energies e = energies(scene_, energy_elements(elastic_, masses_), state.x, state.v, acceleration);
  found_.energy = std::max(found_.energy, e.kinetic + e.membrane + e.bending);
  return e.total();
}

void StabilityWatch::operator()(const FrameEvent& event) {
  const StepReport& report = event.report;
  found_.newton = std::max(found_.newton, report.iterations / std::max(1.0, double(report.substeps)));
  found_.linear = std::max(found_.linear, report.linear_iterations / std::max(1.0, double(report.iterations)));
  if (report.status != StepStatus::accepted) return;
  const State& state = event.state;
  found_.nonfinite += count_nonfinite(state.x) + count_nonfinite(state.v) + !std::isfinite(report.residual);
  for (const Points& obstacle : state.obstacles) found_.nonfinite += count_nonfinite(obstacle);
  if (found_.nonfinite > 0) return;
  State from = before_;
  if (report.collision.jumped > 0) {  // a new start: what jumped did no work, it left cloth inside
    from.obstacles = state.obstacles;
    from.clean = false;
    found_.jumped += report.collision.jumped;
  }
  found_.work += bound_(from, state, event.drive);
  const double left = energy(state, event.drive.acceleration) - found_.work.total();
  found_.unaccounted = std::max(found_.unaccounted, left - lowest_);
  lowest_ = std::min(lowest_, left);
  if (state.frame > (1 - end_part) * setup_.run.frames) {
    end_sum_ += masses_.dot(state.v.rowwise().squaredNorm()) / masses_.sum();
    ++end_frames_;
  }
  before_ = state;
}

StabilityMeasures StabilityWatch::measures() const {
  constexpr double earth = 9.81;  // where nothing falls [m/s2]
  const double gravity = setup_.drive_at(0).acceleration.norm();
  const double fall = std::sqrt(2 * (gravity > 0 ? gravity : earth) * box_diagonal(setup_.scene.rest));
  StabilityMeasures found = found_;
  found.end_speed = end_frames_ > 0 ? std::sqrt(end_sum_ / end_frames_) / fall : 0;
  return found;
}

}  // namespace selvedge

#include "physics/steppers/cutting_stepper.hpp"

#include <utility>

#include "collision/geometry/stopwatch.hpp"
#include "physics/frame/bounded_step.hpp"
#include "physics/recovery/cut_out.hpp"
#include "physics/scene/contact_forces.hpp"
#include "physics/scene/part_of_scene.hpp"

namespace selvedge {
namespace {

class CuttingStepper final : public Stepper {
 public:
  CuttingStepper(const Scene& scene, MakeStepper make, std::unique_ptr<Stepper> whole)
      : scene_(scene), make_(std::move(make)), whole_(std::move(whole)) {}

  const StepperTraits& traits() const override { return whole_->traits(); }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override {
    if (from.cut_out.empty()) return whole_->step(from, drive, dt, to, extras);
    return bounded_step(traits().name, extras.stop, [&] { return step_cut(from, drive, dt, extras.stop, to); });
  }

 private:
  void cut(const std::vector<int>& triangles);
  StepReport step_rest(const State& from, const Drive& drive, double dt, const StopFlag&, State& to);
  StepReport step_cut(const State& from, const Drive& drive, double dt, const StopFlag&, State& to);

  const Scene& scene_;
  MakeStepper make_;
  std::unique_ptr<Stepper> whole_;
  std::vector<int> cut_out_;  // the triangles that part_ lacks
  std::shared_ptr<const PartOfScene> part_;
  std::unique_ptr<Stepper> stepper_;
};

// Makes the part of the scene without these triangles, unless it exists already.
void CuttingStepper::cut(const std::vector<int>& triangles) {
  if (triangles == cut_out_) return;
  cut_out_ = triangles;
  stepper_.reset();  // it refers to the old part
  part_ = std::make_shared<const PartOfScene>(part_of_triangles(scene_, all_but(scene_, triangles)));
  if (!part_->triangles.empty()) stepper_ = make_(part_->scene);
}

// A step with all cloth cut out: only obstacles move.
StepReport step_nothing(const State& from, const Drive& drive, double dt, const std::string& by, State& end) {
  end = from;
  end.time = from.time + dt;
  end.frame = from.frame + 1;
  end.obstacles = drive.obstacles;
  end.pinched = false;
  end.memory.clear();
  StepReport report;
  report.status = StepStatus::accepted;
  report.by = by;
  report.audit.emplace();
  return report;
}

// A step of the cloth that is not cut out; the rest follows Drive::skinned_targets.
StepReport CuttingStepper::step_rest(const State& from, const Drive& drive, double dt, const StopFlag& stop,
                                     State& to) {
  cut(from.cut_out);
  State end;
  const State start = state_of(*part_, from);
  StepReport report = stepper_ ? stepper_->step(start, drive_of(*part_, drive), dt, end, {.stop = stop})
                               : step_nothing(start, drive, dt, traits().name, end);
  if (report.status != StepStatus::accepted) return report;
  to = from;
  to.time = end.time;
  to.frame = end.frame;
  for (Eigen::Index v = 0; v < to.x.rows(); ++v)
    if (drive.skinned_targets.row(v).allFinite()) to.x.row(v) = drive.skinned_targets.row(v);
  to.x(scene_.pins, Eigen::all) = drive.pins;
  to.v = (to.x - from.x) / dt;
  put(*part_, end, to);
  report.path.part = part_;
  if (report.contact_forces) {  // what is cut out touches nothing
    ContactForces whole = no_contact_forces(to.x.rows());
    put(*part_, *report.contact_forces, whole);
    report.contact_forces = std::make_shared<const ContactForces>(std::move(whole));
  }
  return report;
}

StepReport CuttingStepper::step_cut(const State& from, const Drive& drive, double dt, const StopFlag& stop, State& to) {
  StepReport report = step_rest(from, drive, dt, stop, to);
  if (report.status != StepStatus::accepted) return report;
  Stopwatch watch;
  to.cut_out = still_cut_out(scene_, to);
  report.seconds.response += watch.lap();
  if (to.cut_out != from.cut_out) {
    forget_motion(to.memory);  // triangles that come back did not move with the rest
    report.audit.reset();
  } else if (report.audit) {
    report.audit = whole_audit(*part_, *std::move(report.audit));
  }
  report.collision.cut_out = static_cast<int>(to.cut_out.size());
  return report;
}

}  // namespace

std::unique_ptr<Stepper> make_cutting_stepper(const Scene& scene, MakeStepper make, std::unique_ptr<Stepper> whole) {
  return std::make_unique<CuttingStepper>(scene, std::move(make), std::move(whole));
}

}  // namespace selvedge

#include "physics/steppers/carried_stepper.hpp"

#include "collision/geometry/floating_point.hpp"
#include "physics/frame/bounded_step.hpp"
#include "physics/scene/joint_lists.hpp"
#include "physics/scene/scene_numbers.hpp"
#include "physics/steppers/contact_stage.hpp"
#include "physics/steppers/response_stepper.hpp"

namespace selvedge {
namespace {

constexpr const char *target_block = "carried.target", *motion_block = "carried.motion";

bool has_target(const Points& targets, Eigen::Index v) { return targets.rows() > 0 && targets.row(v).allFinite(); }

// The skinned target of cloth that a body wears, the place of all other cloth.
Points all_targets(const Drive& drive, const Points& x) {
  Points all = x;
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if (has_target(drive.skinned_targets, v)) all.row(v) = drive.skinned_targets.row(v);
  return all;
}

class CarriedStepper final : public Stepper {
 public:
  CarriedStepper(const Scene& scene, const CarriedOptions& options)
      : scene_(scene), options_(options), contact_(scene) {
    for (const std::string& joints : joint_names()) traits_.ignores.push_back(joints);
  }

  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override {
    check_time_step(dt, "stepper `" + traits_.name + "`");
    return bounded_step(traits_.name, extras.stop, [&] { return take_step(from, drive, dt, to, extras.stop); });
  }

 private:
  StepReport take_step(const State& from, const Drive& drive, double dt, State& to, const StopFlag& stop);

  const Scene& scene_;
  CarriedOptions options_;
  ContactStage contact_;
  StepperTraits traits_{
      .name = "carried",
      .past_frames = 1,
      .ignores = {"membrane", "bending (curvature)", "bending (hinge)", "stiffness damping", "mass damping", "wind"}};
};

StepReport CarriedStepper::take_step(const State& from, const Drive& drive, double dt, State& to,
                                     const StopFlag& stop) {
  restore_standard_arithmetic();
  StepReport report;
  report.by = traits_.name;
  report.substeps = 1;
  auto end =
      responded_end(contact_, from, drive, dt, carried_guess(scene_, from, drive, dt, options_), nullptr, stop, report);
  if (!end) return report;
  end->memory = carried_memory(from, drive, end->x);
  finish_step(from, drive, dt, *std::move(end), to, report);
  return report;
}

}  // namespace

Points carried_guess(const Scene& scene, const State& from, const Drive& drive, double dt,
                     const CarriedOptions& options) {
  const MemoryRows *target = carried_targets(from), *motion = find_rows(from.memory, motion_block, from.x.rows());
  Points x = from.x;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    if (!has_target(drive.skinned_targets, v))
      x.row(v) += dt * (from.v.row(v) + dt * drive.acceleration.transpose());
    else if (target)
      x.row(v) += drive.skinned_targets.row(v) - target->row(v);
    else
      x.row(v) += dt * from.v.row(v);
    if (has_target(drive.skinned_targets, v) && motion) x.row(v) += options.kept * motion->row(v);
  }
  x(scene.pins, Eigen::all) = drive.pins;
  return x;
}

const MemoryRows* carried_targets(const State& state) { return find_rows(state.memory, target_block, state.x.rows()); }

std::vector<MemoryBlock> carried_memory(const State& from, const Drive& drive, const Points& x) {
  const Points now = all_targets(drive, x);
  Points motion = Points::Zero(x.rows(), 3);
  if (const MemoryRows* before = carried_targets(from)) motion = (x - from.x) - (now - Points(*before));
  return {{target_block, now, RowsOf::vertices, true}, {motion_block, motion, RowsOf::vertices}};
}

std::unique_ptr<Stepper> make_carried_stepper(const Scene& scene, const CarriedOptions& options) {
  return std::make_unique<CarriedStepper>(scene, options);
}

}  // namespace selvedge

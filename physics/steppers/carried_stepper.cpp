#include "physics/steppers/carried_stepper.hpp"

#include <utility>

#include "collision/geometry/floating_point.hpp"
#include "physics/frame/bounded_step.hpp"
#include "physics/scene/joint_lists.hpp"
#include "physics/scene/scene_numbers.hpp"
#include "physics/steppers/contact_stage.hpp"
#include "physics/steppers/response_stepper.hpp"

namespace selvedge {
namespace {

class CarriedStepper final : public Stepper {
 public:
  CarriedStepper(const Scene& scene, CarriedModel model, const char* name)
      : scene_(scene), model_(std::move(model)), contact_(scene) {
    traits_.name = name;
    traits_.past_frames = past_frames(model_);
    traits_.may_leave_out_cloths = model_.own.rows() == 0;
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
  CarriedModel model_;
  ContactStage contact_;
  StepperTraits traits_{
      .name = {},
      .ignores = {"membrane", "bending (curvature)", "bending (hinge)", "stiffness damping", "mass damping", "wind"}};
};

StepReport CarriedStepper::take_step(const State& from, const Drive& drive, double dt, State& to,
                                     const StopFlag& stop) {
  restore_standard_arithmetic();
  StepReport report;
  report.by = traits_.name;
  report.substeps = 1;
  auto end =
      responded_end(contact_, from, drive, dt, carried_guess(scene_, from, drive, dt, model_), nullptr, stop, report);
  if (!end) return report;
  end->memory = carried_memory(from, drive, end->x, traits_.past_frames);
  finish_step(from, drive, dt, *std::move(end), to, report);
  return report;
}

}  // namespace

std::unique_ptr<Stepper> make_carried_stepper(const Scene& scene, CarriedModel model, const char* name) {
  return std::make_unique<CarriedStepper>(scene, std::move(model), name);
}

}  // namespace selvedge

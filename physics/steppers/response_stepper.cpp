#include "physics/steppers/response_stepper.hpp"

#include <utility>

#include "collision/geometry/floating_point.hpp"
#include "physics/frame/bounded_step.hpp"
#include "physics/scene/scene_numbers.hpp"

namespace selvedge {
namespace {

class ResponseStepper final : public Stepper {
 public:
  explicit ResponseStepper(const Scene& scene) : scene_(scene), contact_(scene) {}

  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override {
    check_time_step(dt, "stepper `" + traits_.name + "`");
    return bounded_step(traits_.name, extras.stop, [&] { return take_step(from, drive, dt, to, extras); });
  }

 private:
  StepReport take_step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) {
    restore_standard_arithmetic();
    StepReport report;
    report.by = traits_.name;
    report.substeps = 1;
    Points x = extras.guess ? *extras.guess : from.x + dt * from.v;
    x(scene_.pins, Eigen::all) = drive.pins;
    left_alone_ = extras.left_alone ? *extras.left_alone : Exemption{};
    auto end = responded_end(contact_, from, drive, dt, std::move(x), &left_alone_, extras.stop, report);
    if (end) finish_step(from, drive, dt, *std::move(end), to, report);
    return report;
  }

  const Scene& scene_;
  ContactStage contact_;
  Exemption left_alone_;  // the stage keeps a pointer to it
  StepperTraits traits_{.name = "response", .honours_extras = true};
};

}  // namespace

std::optional<StepEnd> responded_end(ContactStage& contact, const State& from, const Drive& drive, double dt, Points x,
                                     const Exemption* left_alone, const StopFlag& stop, StepReport& report) {
  reject(Reason::not_finite, report);
  if (!x.allFinite()) return {};
  std::vector<Points> obstacles = drive.obstacles;
  ResolveOptions options = contact.options;
  options.stop = stop;
  const ResolveReport resolved = resolve_proposal(contact, options, from, left_alone, x, obstacles);
  add(resolved, report);
  report.reason = resolved.stopped ? Reason::stopped : x.allFinite() ? Reason::none : Reason::not_finite;
  if (report.reason != Reason::none) return {};
  Points v = (x - from.x) / dt;
  return StepEnd{std::move(x), std::move(v), std::move(obstacles)};
}

std::unique_ptr<Stepper> make_response_stepper(const Scene& scene) { return std::make_unique<ResponseStepper>(scene); }

}  // namespace selvedge

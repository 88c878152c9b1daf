#include "pipeline/compare/skinning_stepper.hpp"

#include "physics/scene/scene.hpp"
#include "physics/steppers/finish_step.hpp"

namespace selvedge {
namespace {

class SkinningStepper final : public Stepper {
 public:
  explicit SkinningStepper(const Scene& scene) : scene_(scene) {}
  const StepperTraits& traits() const override { return traits_; }

  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) override {
    StepEnd end{from.x, from.v, drive.obstacles};
    for (Eigen::Index v = 0; v < from.x.rows(); ++v)
      if (drive.worn.row(v).allFinite()) end.x.row(v) = drive.worn.row(v);
    for (std::size_t p = 0; p < scene_.pins.size(); ++p)
      end.x.row(scene_.pins[p]) = drive.pins.row(static_cast<Eigen::Index>(p));
    end.v = (end.x - from.x) / dt;
    StepReport report;
    report.by = traits_.name;
    report.substeps = 1;
    if (!end.x.allFinite()) {
      report.status = StepStatus::rejected;
      report.reason = Reason::not_finite;
      return report;
    }
    finish_step(scene_, from, drive, dt, std::move(end), audits_, to, report);
    return report;
  }

 private:
  const Scene& scene_;
  StepperTraits traits_{.name = "skinning", .needs = {.worn = true}};
  AuditMemory audits_;
};

}  // namespace

std::unique_ptr<Stepper> make_skinning_stepper(const Scene& scene) { return std::make_unique<SkinningStepper>(scene); }

Kinds compared_kinds() {
  Kinds kinds = known_kinds();
  kinds.add({.name = "skinning", .maker = [](const Setup&, const Config&) -> MakeStepper {
               return [](const Scene& scene) { return make_skinning_stepper(scene); };
             }});
  return kinds;
}

}  // namespace selvedge

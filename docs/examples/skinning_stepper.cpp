// A stepper of one's own: cloth goes where the body that wears it takes it, by linear blend skinning, without forces.
// It is a baseline for other steppers, and `selvedge compare` with it. Usage: skinning_stepper COMPARISON.yaml OUT
// [key=value ...]; see docs/library.md.
#include <cstdio>
#include <selvedge/collision/geometry/error.hpp>
#include <selvedge/physics/steppers/finish_step.hpp>
#include <selvedge/pipeline/compare/compare.hpp>

using namespace selvedge;

namespace {

class SkinningStepper final : public Stepper {
 public:
  explicit SkinningStepper(const Scene& scene) : scene_(scene) {}
  const StepperTraits& traits() const override { return traits_; }

  // Vertices that nothing wears stay where they are.
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) override {
    StepEnd end{from.x, from.v, drive.obstacles};
    for (Eigen::Index v = 0; v < from.x.rows(); ++v)
      if (drive.skinned_targets.row(v).allFinite()) end.x.row(v) = drive.skinned_targets.row(v);
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
    finish_step(from, drive, dt, std::move(end), to, report);  // fills `to`
    return report;
  }

 private:
  const Scene& scene_;
  StepperTraits traits_{.name = "skinning", .needs = {.skinned_targets = true}};
};

}  // namespace

int main(int count, char** arguments) try {
  if (count < 3) return 2;
  CompareRequest request;
  request.file = arguments[1];
  request.out = arguments[2];
  request.overrides.assign(arguments + 3, arguments + count);
  request.kinds.add({.name = "skinning", .maker = [](const Setup&, const Config&) -> MakeStepper {
                       return [](const Scene& scene) { return std::make_unique<SkinningStepper>(scene); };
                     }});
  const CompareResult result = compare(request);
  std::fputs(compare_table(result).c_str(), stdout);
  return result.finished ? 0 : 1;
} catch (const Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}

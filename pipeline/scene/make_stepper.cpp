#include "pipeline/scene/make_stepper.hpp"

#include "collision/geometry/error.hpp"
#include "physics/steppers/cutting_stepper.hpp"
#include "physics/steppers/resting_stepper.hpp"
#include "pipeline/config/config.hpp"

namespace selvedge {
namespace {

MakeStepper maker_of(const Setup& setup) {
  const RunOptions& run = setup.run;
  if (run.stepper == "conventional")
    return [options = run.conventional](const Scene& scene) { return make_conventional_stepper(scene, options); };
  if (run.stepper == "icm") return [options = run.icm](const Scene& scene) { return make_icm_stepper(scene, options); };
  throw Error("unknown stepper `" + run.stepper + "`", setup.file.string(), "known: " + joined(known_steppers()));
}

}  // namespace

std::unique_ptr<Stepper> make_stepper(const Setup& setup) {
  const MakeStepper make = maker_of(setup);
  std::unique_ptr<Stepper> whole = setup.run.rest ? make_resting_stepper(setup.scene, make) : make(setup.scene);
  if (setup.initial.cut_out.empty()) return whole;
  return make_cutting_stepper(setup.scene, make, std::move(whole));
}

}  // namespace selvedge

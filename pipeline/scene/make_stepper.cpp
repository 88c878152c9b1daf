#include "pipeline/scene/make_stepper.hpp"

#include <fmt/format.h>

#include <cmath>

#include "collision/geometry/error.hpp"
#include "learned/steppers/learned_stepper.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/config/config.hpp"

namespace selvedge {

WeightFile read_learned_weights(const Setup& setup) {
  const std::string& weights = setup.run.learned.weights;
  if (weights.empty())
    throw Error("the stepper `learned` needs a weight file", setup.file.string() + ": run.learned.weights",
                "give this key or --weights; `selvedge weights import` makes such a file of a published checkpoint");
  return read_weight_file(setup.file.parent_path() / weights);  // an absolute path stays as it is
}

namespace {

MakeStepper maker_of(const Setup& setup) {
  const RunOptions& run = setup.run;
  if (run.stepper == "conventional") return conventional_maker(run.conventional);
  if (run.stepper == "icm") return [options = run.icm](const Scene& scene) { return make_icm_stepper(scene, options); };
  if (run.stepper == "learned")
    return [file = std::make_shared<const WeightFile>(read_learned_weights(setup)),
            options = LearnedOptions{run.learned.settle, {}, {}}](const Scene& scene) {
      return make_learned_stepper(scene, file->architecture, file->weights, options);
    };
  throw Error("unknown stepper `" + run.stepper + "`", setup.file.string(), "known: " + joined(known_steppers()));
}

void check_accepted(const Setup& setup, const StepperTraits& traits) {
  if (!traits.accepts(1 / setup.run.fps))
    throw Error(fmt::format("the stepper `{}` does not make {} frames a second", traits.name, setup.run.fps),
                setup.file.string() + ": run.fps", fmt::format("give fps: {:.0f}", 1 / *traits.only_dt));
  if (!traits.may_leave_out_cloths && !setup.initial.cut_out.empty())
    throw Error(fmt::format("the stepper `{}` steps no cloth that is cut out", traits.name), setup.file.string(),
                "give the garments another start");
}

}  // namespace

std::unique_ptr<Stepper> make_stepper(const Setup& setup) {
  std::unique_ptr<Stepper> stepper =
      decorated(setup.scene, maker_of(setup), {setup.run.rest, !setup.initial.cut_out.empty()});
  check_accepted(setup, stepper->traits());
  return stepper;
}

}  // namespace selvedge

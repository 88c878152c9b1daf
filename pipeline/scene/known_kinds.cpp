#include <memory>

#include "learned/steppers/learned_stepper.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/scene/kinds.hpp"
#include "pipeline/scene/make_stepper.hpp"

namespace selvedge {
namespace {

MakeStepper learned_maker(const Setup& setup) {
  return [file = std::make_shared<const WeightFile>(read_learned_weights(setup)),
          options = LearnedOptions{setup.run.learned.settle, {}, {}}](const Scene& scene) {
    return make_learned_stepper(scene, file->architecture, file->weights, options);
  };
}

}  // namespace

Kinds known_kinds() {
  Kinds kinds;
  kinds.add({.name = "conventional",
             .maker = [](const Setup& setup, const Config&) { return conventional_maker(setup.run.conventional); }});
  kinds.add({.name = "icm", .maker = [](const Setup& setup, const Config&) -> MakeStepper {
               return [options = setup.run.icm](const Scene& scene) { return make_icm_stepper(scene, options); };
             }});
  kinds.add({.name = "learned", .maker = [](const Setup& setup, const Config&) { return learned_maker(setup); }});
  return kinds;
}

}  // namespace selvedge

#include <memory>

#include "learned/steppers/learned_state.hpp"
#include "learned/steppers/learned_stepper.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "physics/steppers/hybrid_stepper.hpp"
#include "pipeline/scene/kinds.hpp"
#include "pipeline/scene/make_stepper.hpp"

namespace selvedge {
namespace {

MakeStepper learned_maker(const Setup& setup) {
  return [file = std::make_shared<const WeightFile>(read_learned_weights(setup)), options = learned_options_of(setup)](
             const Scene& scene) { return make_learned_stepper(scene, file->architecture, file->weights, options); };
}

// The conventional stepper as the scene has it; `newton`: most iterations of a solve.
std::unique_ptr<Stepper> conventional_part(const Scene& scene, ConventionalOptions options,
                                           const RecoveryOptions& recovery, std::optional<int> newton = {}) {
  options.implicit_euler.max_newton = newton.value_or(options.implicit_euler.max_newton);
  return decorated(scene, conventional_maker(options), {.recovery = recovery});
}

MakeStepper hybrid_maker(const Setup& setup) {
  HybridOptions options = setup.run.hybrid;
  options.implicit_euler = setup.run.conventional.implicit_euler;
  return [options, learned = learned_maker(setup), conventional = setup.run.conventional,
          recovery = setup.run.recovery](const Scene& scene) {
    HybridParts parts{learned(scene), conventional_part(scene, conventional, recovery)};
    if (options.mode == HybridMode::refined && options.newton)
      parts.refiner = conventional_part(scene, conventional, recovery, options.newton);
    parts.hand_over = carry_frame;
    return make_hybrid_stepper(scene, std::move(parts), options);
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
  kinds.add({.name = "hybrid", .maker = [](const Setup& setup, const Config&) { return hybrid_maker(setup); }});
  return kinds;
}

}  // namespace selvedge

#include <fmt/format.h>

#include <map>
#include <memory>

#include "learned/network/weights_hdf5.hpp"
#include "learned/steppers/learned_state.hpp"
#include "learned/steppers/learned_stepper.hpp"
#include "physics/steppers/carried_stepper.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "physics/steppers/hybrid_stepper.hpp"
#include "physics/steppers/one_rough_solve.hpp"
#include "pipeline/scene/kinds.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/weights/carried_model_hdf5.hpp"

namespace selvedge {
namespace {

StepperKind conventional_kind() {
  StepperKind kind{.name = "conventional", .minimises = true};
  kind.maker = [](const Setup& setup, const Config&) { return conventional_maker(setup.run.conventional); };
  return kind;
}

std::vector<PlanLine> carried_lines(const Setup&) {
  return {{"carried guess", true, "cloth goes along with its skinned target, and on by a part of its last motion"},
          {"solve", false, "left out by the stepper carried, with every elastic force, and gravity on dressed cloth"}};
}

StepperKind carried_kind() {
  StepperKind kind{.name = "carried", .plan = carried_lines};
  kind.maker = [](const Setup&, const Config&) -> MakeStepper {
    return [](const Scene& scene) { return make_carried_stepper(scene); };
  };
  return kind;
}

TaughtCarried taught_carried(const Setup& setup) {
  const std::filesystem::path file = weights_of(setup, "`selvedge teach` makes such a file");
  TaughtCarried taught = read_taught_carried(file);
  check_fits(taught, setup.scene.surface, file);
  return taught;
}

std::vector<PlanLine> carried_fitted_lines(const Setup& setup) {
  const TaughtCarried taught = taught_carried(setup);
  std::string sets = taught.model.own.rows() > 0 ? "each vertex has its own" : "one set for all vertices";
  return {{"carried guess", true, "coefficients fitted on " + joined(taught.clips) + "; " + sets},
          {"solve", false, "left out by the stepper carried_fitted, with every elastic force"}};
}

StepperKind carried_fitted_kind() {
  StepperKind kind{.name = carried_fitted_name, .coefficients = true, .plan = carried_fitted_lines};
  kind.maker = [](const Setup& setup, const Config&) -> MakeStepper {
    return [model = taught_carried(setup).model](const Scene& scene) {
      return make_carried_stepper(scene, model, carried_fitted_name);
    };
  };
  return kind;
}

std::vector<PlanLine> icm_lines(const Setup& setup) {
  const std::string untouched = "left out by the stepper icm";
  return {{"contour energy", true, "weight " + fmt::format("{}", setup.run.icm.contour_weight)},
          {"continuous detection", false, untouched + ": what passes through on the way is found by the audit"},
          {"impulses and impact zones", false, untouched + ": nothing undoes a motion"},
          {"recovery before a step", false, untouched + ": the contour energy does it within"},
          {"obstacles that give way", false, untouched + ": they are where they are wanted"}};
}

// What the scene says of the integrator, and of the number and the accuracy of solves, is replaced.
ConventionalOptions carried_rough_options(const Setup& setup) {
  ConventionalOptions options = one_rough_solve(setup.run.conventional);
  options.guess = FirstGuess::carried;
  options.integrator = Integrator::implicit_euler;
  options.name = "carried_rough";
  return options;
}

std::vector<PlanLine> carried_rough_lines(const Setup&) {
  return {{"carried guess", true, "the solve begins there where the potential is lower than as the cloth moves"},
          {"solve", true, "one, rough, whatever run.quality and solver say: as run.quality: draft"}};
}

StepperKind carried_rough_kind() {
  StepperKind kind{.name = "carried_rough", .plan = carried_rough_lines};
  kind.maker = [](const Setup& setup, const Config&) { return conventional_maker(carried_rough_options(setup)); };
  return kind;
}

StepperKind icm_kind() {
  StepperKind kind{.name = "icm", .plan = icm_lines};
  kind.maker = [](const Setup& setup, const Config&) -> MakeStepper {
    return [options = setup.run.icm](const Scene& scene) { return make_icm_stepper(scene, options); };
  };
  kind.check = [](const Config& scene) {
    const Config& integrator = scene["solver"]["integrator"];
    if (integrator.text() == "bdf2")
      integrator.fail("is not one of the stepper `icm`", "leave it out, or take the stepper `conventional`");
  };
  return kind;
}

LearnedOptions learned_options(const Setup& setup) {
  return {.settle = setup.run.learned.settle,
          .omitted_body_vertices = {},
          .centres = {},
          .device = setup.run.learned.device,
          .numbers = setup.run.learned.numbers,
          .step_lengths = setup.run.learned.step_lengths};
}

MakeStepper learned_maker(const Setup& setup, const LearnedOptions& options) {
  const std::shared_ptr<const WeightFile> network(setup.networks, &network_of(setup));
  return [network, options](const Scene& scene) {
    return make_learned_stepper(scene, network->architecture, network->weights, options);
  };
}

std::vector<PlanLine> network_lines(const Setup& setup, const LearnedOptions& options) {
  const Architecture& architecture = network_of(setup).architecture;
  StepperTraits traits = learned_traits(architecture);
  traits.name = setup.kind.name;
  check_accepted(setup, traits);
  return learned_plan_lines(setup.scene, architecture, options);
}

StepperKind learned_kind() {
  StepperKind kind{.name = "learned", .network = NetworkUse::alone};
  kind.plan = [](const Setup& setup) { return network_lines(setup, learned_options(setup)); };
  kind.maker = [](const Setup& setup, const Config&) { return learned_maker(setup, learned_options(setup)); };
  return kind;
}

std::unique_ptr<Stepper> conventional_part(const Scene& scene, const ConventionalOptions& options,
                                           const RecoveryOptions& recovery) {
  return decorated(scene, conventional_maker(options), {.recovery = recovery});
}

// A solve that begins at the whole output ends nearer than one from where lengths lead (docs/results/hybrid.md).
LearnedOptions proposer_options(const Setup& setup) {
  LearnedOptions options = learned_options(setup);
  options.step_lengths = options.step_lengths && setup.run.hybrid.mode != HybridMode::rough;
  return options;
}

MakeStepper hybrid_maker(const Setup& setup) {
  return [options = setup.run.hybrid, learned = learned_maker(setup, proposer_options(setup)),
          features = network_of(setup).architecture.features, conventional = setup.run.conventional,
          recovery = setup.run.recovery](const Scene& scene) {
    HybridParts parts{learned(scene), conventional_part(scene, conventional, recovery)};
    if (options.mode == HybridMode::rough)
      parts.refiner = conventional_part(scene, one_rough_solve(conventional), recovery);
    parts.hand_over = [features](const State& from, const Drive& drive, State& to) {
      carry_frame(features, from, drive, to);
    };
    return make_hybrid_stepper(scene, std::move(parts), options);
  };
}

// What proposes, what becomes of it, and what the network leaves out.
std::vector<PlanLine> hybrid_lines(const Setup& setup) {
  static const std::map<HybridMode, std::string> modes{
      {HybridMode::fallback, "a proposal that the guard admits is the step"},
      {HybridMode::corrected, "its motion goes through the response to contact, then the guard"},
      {HybridMode::response, "its motion goes through the response to contact, then audits and energy decide"},
      {HybridMode::rough, "one rough solve begins at it, then audits and energy decide"}};
  const HybridOptions& hybrid = setup.run.hybrid;
  std::vector<PlanLine> lines{
      {"proposals", true, modes.at(hybrid.mode)},
      {"guard", true, "refused steps are taken by the conventional stepper"},
      {"proposals by time", hybrid.stop_when_slow,
       hybrid.stop_when_slow ? "none where they cost more than they save: frames depend on the clock"
                             : "not asked for by run.hybrid.stop_when_slow"}};
  for (const PlanLine& line : network_lines(setup, proposer_options(setup)))
    if (line.feature != "settling pass") lines.push_back({"proposal: " + line.feature, line.in, line.why});
  return lines;
}

StepperKind hybrid_kind() {
  StepperKind kind{.name = "hybrid", .network = NetworkUse::guarded, .plan = hybrid_lines};
  kind.maker = [](const Setup& setup, const Config&) { return hybrid_maker(setup); };
  return kind;
}

}  // namespace

Kinds known_kinds() {
  Kinds kinds;
  for (StepperKind& kind : std::vector{conventional_kind(), carried_kind(), carried_fitted_kind(), carried_rough_kind(),
                                       icm_kind(), learned_kind(), hybrid_kind()})
    kinds.add(std::move(kind));
  return kinds;
}

}  // namespace selvedge

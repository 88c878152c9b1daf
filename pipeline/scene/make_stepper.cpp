#include "pipeline/scene/make_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "learned/steppers/refu_stepper.hpp"
#include "physics/scene/features.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/hdf5/neighbour_scale_hdf5.hpp"
#include "pipeline/scene/network_warnings.hpp"

namespace selvedge {

std::filesystem::path weights_of(const Setup& setup, const std::string& cure) {
  const std::string& weights = setup.run.learned.weights;
  if (weights.empty())
    throw Error("the stepper `" + setup.kind.name + "` needs a weight file",
                setup.file.string() + ": run.learned.weights", "give this key or --weights; " + cure);
  return setup.file.parent_path() / weights;  // an absolute path stays as it is
}

bool reads_weights(const Setup& setup) { return setup.kind.network != NetworkUse::none || setup.kind.coefficients; }

const WeightFile& network_of(const Setup& setup) {
  const std::filesystem::path file =
      weights_of(setup, "`selvedge weights import` makes such a file of a published checkpoint");
  const auto known = setup.networks->find(file);
  return known != setup.networks->end() ? known->second
                                        : setup.networks->emplace(file, read_weight_file(file)).first->second;
}

std::shared_ptr<const NeighbourScale> read_refu_weights(const Setup& setup) {
  const std::string& weights = setup.run.refu.weights;
  if (weights.empty()) return nullptr;
  return std::make_shared<const NeighbourScale>(read_neighbour_scale(setup.file.parent_path() / weights));
}

namespace {

// Why the stepper does not take the scene, and what to do.
struct Refusal {
  std::string what, where, cure;
};

std::vector<Refusal> refusals(const Setup& setup, const StepperTraits& traits) {
  std::vector<Refusal> all;
  if (!traits.accepts(1 / setup.run.fps))
    all.push_back({fmt::format("it does not make {} frames a second", setup.run.fps), "run.fps",
                   fmt::format("give fps: {:.0f}", 1 / traits.only_dt.value_or(1))});
  if (!traits.may_leave_out_cloths && !setup.initial.cut_out.empty())
    all.push_back({"it steps no cloth that is cut out", "cloths", "give the garments another start"});
  if (traits.needs.obstacles && setup.scene.obstacles.empty())
    all.push_back({"it needs an obstacle", "obstacles", "add one"});
  if (!traits.needs.skinned_targets && !traits.needs.bodies) return all;
  const Drive start = setup.drive_at(setup.initial.time);
  if (traits.needs.skinned_targets && start.skinned_targets.rows() == 0)
    all.push_back({"it needs cloth that a body wears", "cloths", "give a garment"});
  if (traits.needs.bodies && std::ranges::none_of(start.bodies, [](const BodyFrame& b) { return b.is_body(); }))
    all.push_back({"it needs a body", "obstacles", "give an obstacle with a `body`"});
  return all;
}

}  // namespace

void check_accepted(const Setup& setup, const StepperTraits& traits) {
  std::string what, where, cure;
  const auto append = [](std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; };
  for (const Refusal& refusal : refusals(setup, traits)) {
    append(what, refusal.what);
    append(where, refusal.where);
    append(cure, refusal.cure);
  }
  if (!what.empty())
    throw Error("the stepper `" + traits.name + "` does not take this scene: " + what,
                setup.file.empty() ? "scene: " + where : setup.file.string() + ": " + where, cure);
}

namespace {

std::unique_ptr<Stepper> with_refu(const Setup& setup, std::unique_ptr<Stepper> stepper) {
  if (!setup.run.refu.on) return stepper;
  RefuOptions options;
  options.alpha = setup.run.refu.alpha;
  options.neighbours = read_refu_weights(setup);
  options.edge_pass.rounds = setup.run.refu.edge_pass;
  LayerOrder& order = options.repulsion.order;
  order.reach = setup.run.refu.order;
  if (order.reach > 0 && order.reach <= options.repulsion.margin)
    throw Error(fmt::format("is {:g} m, no more than what is left between body and cloth", order.reach),
                setup.file.string() + ": run.refu.order",
                fmt::format("give 0, or more than {:g} m", options.repulsion.margin));
  return make_refu_stepper(setup.scene, std::move(stepper), options);
}

}  // namespace

std::unique_ptr<Stepper> make_stepper(const Setup& setup) {
  std::unique_ptr<Stepper> stepper =
      decorated(setup.scene, setup.kind.maker(setup, setup.kind_options),
                {setup.run.rest, !setup.initial.cut_out.empty(), setup.run.recovery, setup.run.resting});
  check_accepted(setup, stepper->traits());
  stepper = with_refu(setup, std::move(stepper));
  return make_following_stepper(setup.scene, setup.followers, std::move(stepper));
}

std::vector<std::string> scene_warnings(const Setup& setup) {
  std::vector<std::string> warnings = setup.warnings;
  if (setup.kind.network == NetworkUse::none) return warnings;
  const Vec3 gravity = setup.drive_at(0).acceleration;
  for (const std::string& one : network_warnings(setup.scene, gravity, network_of(setup), setup.run.learned.weights))
    warnings.push_back(one);
  return warnings;
}

std::vector<std::string> run_warnings(const Setup& setup, const StepperTraits& traits) {
  std::vector<std::string> warnings = scene_warnings(setup);
  for (const PlanLine& line : ignored_lines(setup.scene, traits)) warnings.push_back(line.feature + ": " + line.why);
  if (setup.run.conventional.contact_forces && !traits.reports_contact_forces)
    warnings.push_back("run.contact_forces: the stepper `" + traits.name + "` computes none");
  return warnings;
}

}  // namespace selvedge

#include "pipeline/training/training_options.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "learned/network/architecture.hpp"
#include "learned/network/architecture_limits.hpp"
#include "pipeline/garments/outfit.hpp"
#include "pipeline/meshes/setup_paths.hpp"
#include "pipeline/motions/clip_split.hpp"

namespace selvedge {
namespace {

using namespace table;

constexpr Range from_0_to_1{.low = 0, .high = 1};

const Options<LossRamp>& ramp_options() {
  using O = LossRamp;
  static const Options<O> table("ramp", "A number over the run, linear between beginning and end.",
                                {number("from", &O::from, Unit::none, not_negative, "before the beginning"),
                                 number("to", &O::to, Unit::none, not_negative, "from the end on"),
                                 number("begin", &O::begin, Unit::none, from_0_to_1, "part of the run"),
                                 number("end", &O::end, Unit::none, from_0_to_1, "part of the run")});
  return table;
}

template <class Struct>
Option<Struct> ramp(std::string name, LossRamp Struct::*member, std::string about) {
  return renamed(section(member, ramp_options(), std::move(about)), std::move(name));
}

const Options<VertexMaterial>& training_material_options() {
  using O = VertexMaterial;
  static const Options<O> table(
      "material", "Isotropic, St. Venant-Kirchhoff.",
      {number("density", &O::density, Unit::areal_density, positive, ""),
       number("lame_mu", &O::lame_mu, Unit::stiffness, positive, "thickness included"),
       number("lame_lambda", &O::lame_lambda, Unit::stiffness, not_negative, "thickness included"),
       number("hinge_bending", &O::bending, Unit::bending, not_negative, "the papers' coefficient")});
  return table;
}

const Options<ForceSampling>& force_sampling_options() {
  using O = ForceSampling;
  static const Options<O> table(
      "forces", "On the cloth beside gravity, of networks with inputs for accelerations; one a roll-out.",
      {number("strongest", &O::strongest, Unit::acceleration, not_negative,
              "the strength is uniform up to here, the direction on the sphere; 0: none"),
       number("wind_share", &O::wind_share, Unit::none, from_0_to_1,
              "of roll-outs: a wind on each triangle, as strong on one that faces it"),
       number("sheet_share", &O::sheet_share, Unit::none, from_0_to_1,
              "of roll-outs: of a hung sheet without a body, in place of a garment")});
  return table;
}

const Options<SampleOptions>& sample_options() {
  using O = SampleOptions;
  static const Options<O> table(
      "samples", "What a network is trained on. Nothing of the validation split is taken.",
      {texts("garments", &O::garments, "by code, or outfits of outfits.yaml"),
       number("edge", &O::edge, Unit::length, positive, "of the triangles of garments by code"),
       texts("clips", &O::clips, "procedural; left out: all of the training split"),
       integer("shapes", &O::shapes, at_least_one, "of the body; the first is the mean one"),
       number("shape_spread", &O::shape_spread, Unit::none, not_negative, "standard deviations of the coefficients"),
       section(&O::material, training_material_options(), "HOOD's where it is left out"),
       choice("sample_materials", &O::sample_materials,
              {{"none", MaterialSampling::none},
               {"garment", MaterialSampling::garment},
               {"vertex", MaterialSampling::vertex}},
              "over the authors' ranges, anew for each roll-out: `garment`: one for each; `vertex`: two for each, "
              "mixed over its rest shape; `none`: `material`"),
       number("still_share", &O::still_share, Unit::none, from_0_to_1,
              "of roll-outs that begin at rest, with a frame of 1/3 s in which the cloth falls"),
       number("noise", &O::noise, Unit::length, not_negative, "of start positions, standard deviation"),
       flag("yaw", &O::yaw, "each roll-out turned about the vertical at random"),
       flag("mirror", &O::mirror, "every second roll-out left for right"),
       number("no_body_share", &O::no_body_share, Unit::none, from_0_to_1, "of roll-outs, without the body"),
       flag("flesh", &O::soft_tissue, "the body gives way where it would pass through itself"),
       choice("start", &O::start,
              {{"skinned", GarmentStart::skinned},
               {"untangle", GarmentStart::untangle},
               {"cut", GarmentStart::cut},
               {"tangled", GarmentStart::tangled}},
              "`skinned`: where the body takes the garment; `untangle`: the same, parted; `cut`: the same "
              "without the triangles that intersect, as released; `tangled`: without the gap between layers and with "
              "soft tissue that does not give way"),
       section(&O::forces, force_sampling_options(), "")});
  return table;
}

const Options<PoolOptions>& pool_options() {
  using O = PoolOptions;
  static const Options<O> table(
      "pool", "How states are rolled out.",
      {integer("states", &O::states, at_least_one,
               "that are advanced one at a time at random; 1: one roll-out after another, as published"),
       ramp("frames", &O::frames, "most frames of a roll-out"),
       flag("random_length", &O::random_length, "a roll-out's length is random up to that"),
       integer("passes", &O::passes, at_least_one, "runs of the network a frame, an optimiser step each"),
       integer("gate", &O::gate, not_negative,
               "how many factors of the network's correction, up to 1.2, are tried before a state is advanced, the "
               "loss being of the whole correction; 0: it is taken as it is"),
       number("reset_distance", &O::reset_distance, Unit::length, positive,
              "of a vertex from the skinned garment, at which a roll-out ends"),
       number("long_share", &O::long_share, Unit::none, from_0_to_1, "of roll-outs that go on for `long_frames`"),
       integer("long_frames", &O::long_frames, at_least_one, "of a long roll-out, or to the clip's end"),
       flag("safeguarded", &O::safeguarded,
            "states are advanced through Bridson's response, and left where that gives up"),
       number("no_contact_share", &O::no_contact_share, Unit::none, from_0_to_1,
              "of roll-outs without cloth-cloth edges and terms")});
  return table;
}

const Options<ContactOptions>& training_contact_options() {
  using O = ContactOptions;
  static const Options<O> table(
      "contact", "Which pairs of cloth see each other.",
      {flag("edges", &O::edges, "of cloth with cloth, in the graph"),
       flag("classify", &O::classify, "pairs repel or not by contours; false: all repel"),
       flag("attraction", &O::attraction, "pairs that do not repel are edges; false: they are left out")});
  return table;
}

const Options<SpaceOptions>& space_options() {
  using O = SpaceOptions;
  static const Options<O> table(
      "space", "Edges between vertices of cloth near each other, of networks that have them.",
      {number("radius", &O::radius, Unit::length, not_negative, "0: there are none"),
       number("radius_in_edges", &O::radius_in_edges, Unit::none, not_negative,
              "above 0: the radius in mean mesh edges at rest, in place of `radius`"),
       flag("mesh_pairs", &O::mesh_pairs, "with pairs that a mesh edge joins"),
       flag("rest_pairs", &O::rest_pairs, "with pairs that are as near at rest"),
       integer("nearest", &O::nearest, not_negative,
               "above 0: only so many nearest of each vertex, and one direction (10: as released)"),
       integer("pairs_per_vertex", &O::pairs_per_vertex, at_least_one,
               "on average; those farthest apart beyond are left out and counted")});
  return table;
}

const Options<CollisionLoss>& collision_options() {
  using O = CollisionLoss;
  static const Options<O> table(
      "collision", "With the body.",
      {ramp("weight", &O::weight, "[N/m2], of the quadratic penalty [N/m]"),
       number("thickness", &O::thickness, Unit::length, positive, "that cloth keeps from the body"),
       choice("matching", &O::matching,
              {{"nearest_centroid", BodyMatching::nearest_centroid}, {"nearest_face", BodyMatching::nearest_face}},
              "which face belongs to a vertex"),
       number("radius", &O::radius, Unit::length, positive, "of `nearest_face`"),
       choice("penalty", &O::penalty, {{"cubic", DepthPenalty::cubic}, {"quadratic", DepthPenalty::quadratic}}, "")});
  return table;
}

const Options<FrictionLoss>& friction_options() {
  using O = FrictionLoss;
  static const Options<O> table(
      "friction", "On the body.",
      {ramp("weight", &O::weight, ""), number("coefficient", &O::coefficient, Unit::none, not_negative, ""),
       number("squared_radius", &O::squared_radius, Unit::none, positive, "of nearest centroids [m2]"),
       choice("slope", &O::slope, {{"x", SlopeAxis::x}, {"y", SlopeAxis::y}, {"z", SlopeAxis::z}},
              "the axis along which a slide has less friction; `z` as released, y being up")});
  return table;
}

const Options<RepulsionLoss>& repulsion_options() {
  using O = RepulsionLoss;
  static const Options<O> table(
      "repulsion", "Between layers of cloth, of pairs that repel.",
      {ramp("weight", &O::weight, "[N/m2]"), number("thickness", &O::thickness, Unit::length, positive, ""),
       number("correspondence", &O::correspondence, Unit::length, positive, "farther apart pairs take no part"),
       number("pinned_factor", &O::pinned_factor, Unit::none, positive, "inside the cube, of pairs with a pin")});
  return table;
}

const Options<ContourLoss>& contour_options() {
  using O = ContourLoss;
  static const Options<O> table(
      "contours", "Squared lengths of intersection contours.",
      {ramp("weight", &O::weight, "[N/m]"),
       choice("gradient", &O::gradient,
              {{"translational", ContourGradient::translational}, {"full", ContourGradient::full}},
              "`translational`: triangles are moved, not shortened"),
       choice("normal", &O::normal, {{"frozen", ContourNormal::frozen}, {"turning", ContourNormal::turning}},
              "`frozen` as published; `turning`: the exact derivative")});
  return table;
}

const Options<PenetrationOptions>& region_options() {
  using O = PenetrationOptions;
  static const Options<O> table(
      "regions", "Which volume contours enclose.",
      {choice("rule", &O::regions, {{"single", RegionRule::single}, {"parity", RegionRule::parity}},
              "`single`: of each contour alone, as published; `parity`: of those with the same partner together"),
       choice("side", &O::smaller, {{"faces", SmallerSide::faces}, {"area", SmallerSide::area}},
              "what the side that counts as inside has less of")});
  return table;
}

const Options<VolumeLoss>& volume_options() {
  using O = VolumeLoss;
  static const Options<O> table(
      "volume", "What self-penetrating cloth encloses (Liao et al. 2024).",
      {ramp("weight", &O::weight, "[J/m3] of 6 times the volume, as published 3e4; of `area` [J/m2]"),
       choice("form", &O::form, {{"enclosed", VolumeForm::enclosed}, {"winding", VolumeForm::winding}},
              "`enclosed`: holes closed by fans; `winding`: by winding numbers, without fans"),
       section(&O::regions, region_options(), ""),
       choice("measure", &O::measure, {{"volume", PenetrationMeasure::volume}, {"area", PenetrationMeasure::area}}, ""),
       choice("crossings", &O::crossings,
              {{"exact", CrossingMotion::exact},
               {"frozen_on_edge", CrossingMotion::frozen_on_edge},
               {"frozen_on_face", CrossingMotion::frozen_on_face}},
              "how they follow the vertices: `exact`: they slide; the others as published"),
       number("saturation", &O::saturation, Unit::volume, not_negative,
              "of a region: up to here it is pressed on evenly, beyond its pressure falls as 1 / V; 0: nowhere, as "
              "published; `area` and what a garment does to itself in the form `winding` have none")});
  return table;
}

const Options<VertexRepulsionLoss>& vertex_repulsion_options() {
  using O = VertexRepulsionLoss;
  static const Options<O> table("vertex_repulsion", "Of vertices that no edge joins (Liao et al. 2024, appendix A).",
                                {ramp("weight", &O::weight, "[J/m] or [J/m2], by the power"),
                                 number("distance", &O::distance, Unit::length, positive, "below which they repel"),
                                 integer("power", &O::power, {.low = 1, .high = 2}, "of what lacks to that")});
  return table;
}

const Options<LossOptions>& objective_options() {
  using O = LossOptions;
  static const Options<O> table(
      "objective", "Weights of the terms over the run; a term whose weight is zero is left out.",
      {ramp("stretching", &O::stretching, ""), ramp("bending", &O::bending, ""), ramp("gravity", &O::gravity, ""),
       ramp("inertia", &O::inertia, ""), section(&O::collision, collision_options(), ""),
       section(&O::friction, friction_options(), ""), section(&O::repulsion, repulsion_options(), ""),
       section(&O::contours, contour_options(), ""), section(&O::volume, volume_options(), ""),
       section(&O::vertex_repulsion, vertex_repulsion_options(), ""),
       number("gravity_strength", &O::gravity_strength, Unit::none, not_negative, "against y [m/s2]"),
       number("relaxation_dt", &O::relaxation_dt, Unit::time, positive,
              "of the inertia of a frame in which cloth falls to rest")});
  return table;
}

const Options<OptimiserOptions>& optimiser_options() {
  using O = OptimiserOptions;
  static const Options<O> table(
      "optimiser", "Adam, one sample a step.",
      {number("learning_rate", &O::learning_rate, Unit::none, positive, ""),
       choice("decay", &O::decay, {{"cosine", Decay::cosine}, {"halving", Decay::halving}, {"none", Decay::none}},
              "of the learning rate: to zero over the run, or as published"),
       integer("halving_steps", &O::halving_steps, at_least_one, "of the decay `halving`"),
       number("floor", &O::floor, Unit::none, not_negative, "of the decay `halving`, added to the factor"),
       flag("normalise_samples", &O::normalise_samples, "each sample's gradient is divided by its own size"),
       flag("clip_median", &O::clip_median, "`clip` counts in running medians of the gradient's norm"),
       number("clip", &O::clip, Unit::none, positive, "largest norm of a step's gradient"),
       integer("warm_up", &O::warm_up, not_negative, "states that only feed the statistics of the inputs"),
       flag("freeze_statistics", &O::freeze_statistics, "after the warm-up"),
       number("decoder_scale", &O::decoder_scale, Unit::none, positive, "of the last layer's weights at the start")});
  return table;
}

const Options<WatchOptions>& watch_options() {
  using O = WatchOptions;
  static const Options<O> table(
      "watch", "When a run writes and measures, all on the training split.",
      {number("checkpoint_minutes", &O::checkpoint_minutes, Unit::none, not_negative, "between checkpoints"),
       integer("measurements", &O::measurements, at_least_one, "of the run: roll-outs, and gaps on fixed states"),
       integer("frames", &O::frames, at_least_one, "of a measuring roll-out"),
       text("garment", &O::garment, "of the measuring roll-out; left out: the first"),
       text("clip", &O::clip, "of the measuring roll-out"),
       integer("fixed_states", &O::fixed_states, at_least_one, "of which the gap to the optimum is printed"),
       integer("most_bad_samples", &O::most_bad_samples, at_least_one,
               "without a finite loss, one after another, before the run stops"),
       number("keep_at", &O::keep_at, Unit::none, from_0_to_1,
              "part of the run at which the weights are kept as `kept.h5`; 0: they are not")});
  return table;
}

void check_names(const TrainingOptions& options, const std::string& where) {
  const Wardrobe wardrobe = read_wardrobe(config_folder() / "outfits.yaml");
  std::vector<std::string> known = wardrobe.training;
  for (const Outfit& outfit : wardrobe.outfits)
    if (!outfit.validation) known.push_back(outfit.name);
  const auto refuse = [&](const std::string& key, const std::string& name, const std::vector<std::string>& allowed) {
    if (std::ranges::find(allowed, name) == allowed.end())
      throw Error(fmt::format("`{}` is not for training, or unknown", name), where + ": " + key,
                  "for training: " + joined(allowed) + suggestion(name, allowed));
  };
  if (options.samples.garments.empty()) throw Error("names no garment", where + ": samples.garments", "");
  for (const std::string& name : options.samples.garments) refuse("samples.garments", name, known);
  if (!options.watch.garment.empty()) refuse("watch.garment", options.watch.garment, options.samples.garments);
  std::vector<std::string> clips;
  for (const ClipEntry& entry : read_clip_split(config_folder() / "clips.yaml"))
    if (!entry.validation) clips.push_back(entry.name);
  for (const std::string& name : options.samples.clips) refuse("samples.clips", name, clips);
  refuse("watch.clip", options.watch.clip, clips);
}

void read_over_base(const std::filesystem::path& file, const std::vector<std::string>& overrides, int depth,
                    TrainingOptions& options) {
  const Config config = read_config(file, training_options().section, overrides);
  if (const Config& base = config["base"]; base.given) {
    if (depth > 8) base.fail("leads back to this file", "let the first file have no base");
    read_over_base(existing_path(base, file.parent_path()), {}, depth + 1, options);
  }
  read_options(training_options().rows, config, options);
  if (const Config& weights = config["weights"]; weights.given)
    options.weights = expanded_path(weights, weights.text(), file.parent_path()).string();
}

}  // namespace

const Options<TrainingOptions>& training_options() {
  using O = TrainingOptions;
  static const Options<O> table(
      "training", "The whole file.",
      {text("description", "for people"),
       path("base", "a training file whose values count where this one gives none; seen from this file"),
       text("name", &O::name, "of the run; left out: the file's"),
       word("architecture", &O::architecture, preset_names(), "of the network"),
       integer("width", &O::width, {.low = 0, .high = most_latents},
               "of latents, in place of the architecture's; 0: its own"),
       integer("message_steps", &O::message_steps, {.low = 0, .high = most_message_steps},
               "in place of the architecture's; 0: its own"),
       number("contour_force", &O::contour_force, Unit::none, not_negative,
              "weight of the contours in the force that the network is shown [N/m]; 0: they have no part in it"),
       path("weights", &O::weights, "to start from, of an earlier stage; seen from this file"),
       integer("seed", &O::seed, not_negative, "of all that is random"),
       integer("steps", &O::steps, at_least_one, "of the optimiser, in all"),
       choice("device", &O::device, network_devices(),
              "what goes forward and backward through the network, as `learned.device` of a scene: the rest of a step "
              "stays on the CPU; a run may be resumed with another"),
       section(&O::samples, sample_options(), ""), section(&O::pool, pool_options(), ""),
       section(&O::contact, training_contact_options(), ""), section(&O::space, space_options(), ""),
       section(&O::objective, objective_options(), ""), section(&O::optimiser, optimiser_options(), ""),
       section(&O::watch, watch_options(), "")});
  return table;
}

TrainingOptions read_training(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  TrainingOptions options;
  read_over_base(file, overrides, 0, options);
  if (options.name.empty()) options.name = file.stem().string();
  check_names(options, file.string());
  return options;
}

std::string training_yaml(const TrainingOptions& options) { return to_yaml(training_options().written(options)); }

std::string training_reference() {
  std::string page;
  for (const Section* section :
       {&training_options().section, &sample_options().section, &training_material_options().section,
        &force_sampling_options().section, &pool_options().section, &training_contact_options().section,
        &space_options().section, &objective_options().section, &collision_options().section,
        &friction_options().section, &repulsion_options().section, &contour_options().section,
        &volume_options().section, &region_options().section, &vertex_repulsion_options().section,
        &optimiser_options().section, &watch_options().section, &ramp_options().section})
    page += section_chapter(*section);
  return page;
}

std::vector<std::string> unfinished_ramps(const TrainingOptions& options) {
  std::vector<std::string> complaints;
  const auto check = [&](const char* name, const LossRamp& ramp) {
    if (!reaches_its_end(ramp))
      complaints.push_back(
          fmt::format("{} goes from {} to {} between {} and {} of the run: it must stand at its full "
                      "value for the last tenth",
                      name, ramp.from, ramp.to, ramp.begin, ramp.end));
  };
  const LossOptions& losses = options.objective;
  check("pool.frames", options.pool.frames);
  check("objective.stretching", losses.stretching);
  check("objective.bending", losses.bending);
  check("objective.gravity", losses.gravity);
  check("objective.inertia", losses.inertia);
  check("objective.collision.weight", losses.collision.weight);
  check("objective.friction.weight", losses.friction.weight);
  check("objective.repulsion.weight", losses.repulsion.weight);
  check("objective.contours.weight", losses.contours.weight);
  check("objective.volume.weight", losses.volume.weight);
  check("objective.vertex_repulsion.weight", losses.vertex_repulsion.weight);
  return complaints;
}

}  // namespace selvedge

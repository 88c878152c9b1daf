#include "pipeline/training/training_options.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "learned/losses/loss_terms.hpp"
#include "learned/network/architecture.hpp"
#include "pipeline/config/section_tree.hpp"
#include "pipeline/garments/outfit.hpp"
#include "pipeline/motions/clip_split.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/training/objective_options.hpp"

namespace selvedge {
namespace {

using namespace table;

const Options<VertexMaterial>& training_material_options() {
  using O = VertexMaterial;
  static const Options<O> table(
      "material", "An isotropic St. Venant-Kirchhoff material.",
      {number("density", &O::density, Unit::areal_density, positive, "Mass per area."),
       number("lame_mu", &O::lame_mu, Unit::stiffness, positive, "Membrane shear modulus times thickness."),
       number("lame_lambda", &O::lame_lambda, Unit::stiffness, not_negative,
              "First Lame coefficient of the membrane times thickness."),
       number("hinge_bending", &O::bending, Unit::bending, not_negative,
              "Coefficient k of the hinge energy, as `hinge_bending` of a scene.")});
  return table;
}

const Options<ForceSampling>& force_sampling_options() {
  using O = ForceSampling;
  static const Options<O> table(
      "forces",
      "Forces on the cloth beside gravity, one for each roll-out. The network needs inputs for accelerations.",
      {number("strongest", &O::strongest, Unit::acceleration, not_negative,
              "Largest strength of the force, per mass. Strengths are uniform up to it, directions uniform on the "
              "sphere. 0: no force."),
       number("wind_share", &O::wind_share, Unit::none, from_0_to_1,
              "Fraction of roll-outs in which the force is a wind on each triangle. A triangle that faces it at rest "
              "gets the strength drawn."),
       number("sheet_share", &O::sheet_share, Unit::none, from_0_to_1,
              "Fraction of roll-outs with a hanging sheet and no body, in place of a garment.")});
  return table;
}

Option<SampleOptions> people_option() {
  Option<SampleOptions> option(sections("people", person_section(), "[]",
                                        "Who is trained on beside the mannequin: own bodies, clips and garments."));
  option.read = [](const Config& entry, SampleOptions& options) { options.people = entry.items; };
  option.write = [](const SampleOptions& options, Config& entry) { entry.items = options.people; };
  return option;
}

// Written only if it holds something out.
Option<SampleOptions> split_option() {
  Option<SampleOptions> option = section(&SampleOptions::split, split_options(), "What of `people` is held out.");
  option.write = [write = option.write](const SampleOptions& options, Config& entry) {
    const bool holds_out = !options.split.validation.empty() || !options.split.test.empty();
    entry.given = holds_out;
    if (holds_out)
      write(options, entry);
    else
      entry.entries.clear();
  };
  return option;
}

const Options<SampleOptions>& sample_options() {
  using O = SampleOptions;
  static const Options<O> table(
      "samples", "What a network is trained on. The validation split is not used.",
      {texts("garments", &O::garments,
             "Garments that the program makes (docs/garments.md), or outfits of outfits.yaml. `none`: the mannequin "
             "takes no part."),
       number("edge", &O::edge, Unit::length, positive, "Edge length of garments that the program makes."),
       texts("clips", &O::clips, "Procedural clips. Default: all of the training split."),
       integer("shapes", &O::shapes, at_least_one, "Number of body shapes. The first is the mean shape."),
       number("shape_spread", &O::shape_spread, Unit::none, not_negative,
              "Standard deviation of the shape coefficients about those of the body. None changes by more than 3."),
       section(&O::material, training_material_options(),
               "Material of the garments. Values that are left out are HOOD's."),
       choice("sample_materials", &O::sample_materials,
              {{"none", MaterialSampling::none},
               {"garment", MaterialSampling::garment},
               {"vertex", MaterialSampling::vertex}},
              "Random materials of each roll-out, from the ranges of HOOD's authors. `garment`: one for each garment. "
              "`vertex`: two for each garment, mixed over its rest shape. `none`: all have `material`."),
       number("still_share", &O::still_share, Unit::none, from_0_to_1,
              "Fraction of roll-outs that begin at rest, with a first frame of 1/3 s in which the cloth falls."),
       number("noise", &O::noise, Unit::length, not_negative,
              "Standard deviation of the noise on each coordinate of start positions."),
       flag("yaw", &O::yaw, "True: each roll-out is rotated about the vertical by a random angle."),
       flag("mirror", &O::mirror, "True: a random half of the roll-outs is mirrored left to right."),
       number("no_body_share", &O::no_body_share, Unit::none, from_0_to_1, "Fraction of roll-outs without the body."),
       number(
           "folded_share", &O::folded_share, Unit::none, from_0_to_1,
           "Fraction of roll-outs with a hanging sheet in place of a garment, without a body, one corner of the sheet "
           "folded through it. Roll-outs without contact between cloth and cloth are not among them."),
       number("simulated_share", &O::simulated_share, Unit::none, from_0_to_1,
              "Fraction of roll-outs that begin where the solver (`teacher`) has brought the cloth in the clip. "
              "Roll-outs with a folded sheet are not among them."),
       integer("simulated_frames", &O::simulated_frames, at_least_one,
               "Number of frames that the solver makes before such a roll-out, from the skinned garment on."),
       flag("random_simulated", &O::random_simulated,
            "True: that number is random, up to `simulated_frames`. False: it is `simulated_frames`."),
       number("noise_share", &O::noise_share, Unit::none, from_0_to_1,
              "Fraction of roll-outs with strong noise on the start positions in place of `noise`: its standard "
              "deviation on each coordinate is between 1 and 10 mm."),
       flag("flesh", &O::soft_tissue,
            "True: soft tissue of the body gives way where the body would pass through itself."),
       choice("start", &O::start,
              {{"skinned", GarmentStart::skinned},
               {"untangle", GarmentStart::untangle},
               {"cut", GarmentStart::cut},
               {"tangled", GarmentStart::tangled}},
              "How a garment starts. `skinned`: where skinning puts it. `untangle`: the same, untangled. `cut`: the "
              "same without the triangles that intersect, as in ContourCraft's released code. `tangled`: layers "
              "without a gap, on a body whose soft tissue does not give way."),
       section(&O::forces, force_sampling_options(), "Random forces beside gravity."),
       people_option(),
       number("mannequin_weight", &O::mannequin_weight, Unit::none, positive,
              "How often the mannequin is drawn, beside the weights of `people`. Default: 1."),
       split_option()});
  return table;
}

const Options<PoolOptions>& pool_options() {
  using O = PoolOptions;
  static const Options<O> table(
      "pool", "The states from which samples are drawn, and how they are rolled out.",
      {integer(
           "states", &O::states, at_least_one,
           "Number of states. Each step advances a random one of them. 1: one roll-out after another, as published."),
       ramp("frames", &O::frames, "Largest number of frames in a roll-out."),
       flag("random_length", &O::random_length,
            "True: the length of a roll-out is random, up to `frames`. False: it is `frames`."),
       integer("passes", &O::passes, at_least_one,
               "Number of runs of the network in a frame. Each run is an optimiser step."),
       integer("gate", &O::gate, not_negative,
               "Number of factors from 0 to 1.2 on the network's correction, of which the best advances the state. The "
               "loss is that of the whole correction. 0: the correction is taken as it is."),
       number("reset_distance", &O::reset_distance, Unit::length, positive,
              "Distance of a vertex from its skinned target at which a roll-out ends."),
       number("long_share", &O::long_share, Unit::none, from_0_to_1,
              "Fraction of roll-outs that have `long_frames` frames."),
       integer("long_frames", &O::long_frames, at_least_one,
               "Number of frames in a long roll-out, or fewer where the clip ends."),
       flag("safeguarded", &O::safeguarded,
            "True: states advance through Bridson's contact response. A roll-out ends where that gives up."),
       choice("behind", &O::behind,
              {{"nothing", BehindNetwork::nothing},
               {"response", BehindNetwork::response},
               {"solve", BehindNetwork::solve}},
              "What runs behind the network where a state goes on to its next frame. `response`: the response to "
              "contact, as in the stepper `carried`. `solve`: one rough solve from the network's frame, then the "
              "response, as in `carried_rough`. A roll-out ends where that rejects a frame."),
       number("no_contact_share", &O::no_contact_share, Unit::none, from_0_to_1,
              "Fraction of roll-outs without edges and loss terms between cloth and cloth.")});
  return table;
}

const Options<ContactOptions>& training_contact_options() {
  using O = ContactOptions;
  static const Options<O> table(
      "contact", "Pairs of cloth with cloth, in the graph and in the losses.",
      {flag("edges", &O::edges, "True: the graph has world edges between cloth and cloth."),
       flag("classify", &O::classify, "True: contours decide whether a pair repels. False: all pairs repel."),
       flag("attraction", &O::attraction,
            "True: pairs that do not repel get world edges, too. False: they get none.")});
  return table;
}

const Options<SpaceOptions>& space_options() {
  using O = SpaceOptions;
  static const Options<O> table(
      "space", "World edges between cloth vertices that are near each other, for networks that have them.",
      {number("radius", &O::radius, Unit::length, not_negative,
              "Distance within which two vertices get an edge. 0: there are no such edges."),
       number("radius_in_edges", &O::radius_in_edges, Unit::none, not_negative,
              "Above 0: the radius in mean edge lengths of the mesh at rest, in place of `radius`."),
       flag("mesh_pairs", &O::mesh_pairs, "True: pairs that a mesh edge joins get an edge, too."),
       flag("rest_pairs", &O::rest_pairs, "True: pairs that are as near at rest get an edge, too."),
       integer("nearest", &O::nearest, not_negative,
               "Above 0: each vertex has edges to so many nearest ones alone, in one direction. SENC's released code "
               "has 10."),
       integer(
           "pairs_per_vertex", &O::pairs_per_vertex, at_least_one,
           "Largest mean number of pairs of a vertex. Beyond it the pairs farthest apart are left out and counted.")});
  return table;
}

const Options<TeacherOptions>& teacher_options() {
  using O = TeacherOptions;
  static const Options<O> table(
      "teacher", "The solver, where the objective has a term that needs its frames.",
      {choice("quality", &O::quality,
              {{"converged", TeacherQuality::converged}, {"standard", TeacherQuality::standard}},
              "How it makes a frame. `converged`: in one substep, solved closely. `standard`: as a scene without "
              "solver options does."),
       integer("uses", &O::uses, at_least_one,
               "How often a state with its target is learned from in the mean: once as the pool advances, and for the "
               "rest from the `kept` ones. 1: none is kept. More needs one pass a frame."),
       integer("kept", &O::kept, at_least_one,
               "Number of states with targets that are kept where `uses` is above 1. A new one takes the oldest one's "
               "place.")});
  return table;
}

const Options<OptimiserOptions>& optimiser_options() {
  using O = OptimiserOptions;
  static const Options<O> table(
      "optimiser", "Adam.",
      {integer(
           "batch", &O::batch, at_least_one,
           "Number of samples in each step, each of another state of the pool. They are joined in one graph, and the "
           "step is along the mean of their gradients."),
       number("learning_rate", &O::learning_rate, Unit::none, positive, "Learning rate at the start."),
       choice("decay", &O::decay, {{"cosine", Decay::cosine}, {"halving", Decay::halving}, {"none", Decay::none}},
              "How the learning rate decays: `cosine` goes to zero over the run, `halving` is as published."),
       integer("halving_steps", &O::halving_steps, at_least_one,
               "Number of steps after which `halving` halves the learning rate."),
       number("floor", &O::floor, Unit::none, not_negative,
              "Constant that `halving` adds to its factor on the learning rate."),
       flag("normalise_samples", &O::normalise_samples,
            "True: the gradient of each sample is divided by its own size."),
       flag("clip_median", &O::clip_median, "True: `clip` is in running medians of the gradient's norm."),
       number("clip", &O::clip, Unit::none, positive,
              "Largest norm of the gradient in a step. A larger one is scaled down."),
       integer("warm_up", &O::warm_up, not_negative,
               "Number of states at the start that only feed the statistics of the inputs."),
       flag("freeze_statistics", &O::freeze_statistics,
            "True: the statistics of the inputs stay fixed after the warm-up."),
       number("decoder_scale", &O::decoder_scale, Unit::none, not_negative,
              "Factor on the initial weights of the decoder's last layer. 0: the network begins with an output of "
              "zero.")});
  return table;
}

const Options<WatchOptions>& watch_options() {
  using O = WatchOptions;
  static const Options<O> table(
      "watch", "When a run writes and measures. All measurements are on the training split.",
      {number("checkpoint_minutes", &O::checkpoint_minutes, Unit::none, not_negative, "Minutes between checkpoints."),
       integer("measurements", &O::measurements, at_least_one,
               "Number of measurements in the run: of roll-outs, and of the gap to the optimum on fixed states."),
       integer("frames", &O::frames, at_least_one, "Number of frames in a measuring roll-out."),
       text("garment", &O::garment, "Garment of the measuring roll-out. Default: the first one."),
       text("clip", &O::clip, "Clip of the measuring roll-out, of the training split."),
       integer("fixed_states", &O::fixed_states, at_least_one,
               "Number of fixed states whose gap to the optimum is measured."),
       integer("taught_rolls", &O::taught_rolls, at_least_one,
               "Number of roll-outs, each in another clip, that are compared with the solver's where the objective has "
               "a term that needs the solver. The weights that come nearest to it are kept as `best.h5`."),
       integer("taught_frames", &O::taught_frames, at_least_one, "Number of frames after which they are compared."),
       integer("most_bad_samples", &O::most_bad_samples, at_least_one,
               "Number of samples in a row without a finite loss after which the run stops."),
       number("keep_at", &O::keep_at, Unit::none, from_0_to_1,
              "Fraction of the run at which the weights are kept as `kept.h5`. 0: they are not kept.")});
  return table;
}

void check_names(const TrainingOptions& options, const std::string& where) {
  const Wardrobe wardrobe = read_wardrobe(config_folder() / "outfits.yaml");
  std::vector<std::string> known = wardrobe.training, clips = training_clip_names({});
  for (const Outfit& outfit : wardrobe.outfits)
    if (!outfit.validation) known.push_back(outfit.name);
  const auto refuse = [&](const std::string& key, const std::string& name, const std::vector<std::string>& allowed) {
    if (std::ranges::find(allowed, name) == allowed.end())
      throw Error(fmt::format("`{}` is not for training, or unknown", name), where + ": " + key,
                  "for training: " + joined(allowed) + suggestion(name, allowed));
  };
  const SampleOptions& samples = options.samples;
  const auto held_out = [&](const Config& person) {
    return split_of(samples.split, person["name"].text()) != Split::training;
  };
  if (!has_mannequin(samples) && std::ranges::all_of(samples.people, held_out))
    throw Error("names no garment", where + ": samples.garments", "name some, or `people` who are not held out");
  if (has_mannequin(samples))
    for (const std::string& name : samples.garments) refuse("samples.garments", name, known);
  for (const std::string& name : samples.clips) refuse("samples.clips", name, clips);
  check_split(samples.people, samples.split, where);
  std::vector<std::string> worn = samples.garments;
  for (const Config& person : samples.people) {
    if (held_out(person)) continue;
    for (const Config& wear : person["wear"].items)
      if (split_of_wear(samples.split, wear, samples.folder) == Split::training) worn.push_back(wear["name"].text());
    for (const Config& clip : person["clips"].items)
      if (split_of_clip(samples.split, clip) == Split::training) clips.push_back(clip["name"].text());
  }
  if (!options.watch.garment.empty()) refuse("watch.garment", options.watch.garment, worn);
  refuse("watch.clip", options.watch.clip, clips);
}

// The solver knows one material for each cloth, and cloth without triangles cut out.
void check_solver(const TrainingOptions& options, const std::string& where) {
  const SampleOptions& samples = options.samples;
  const PoolOptions& pool = options.pool;
  if (pool.safeguarded && pool.behind != BehindNetwork::nothing)
    throw Error("states cannot advance through two responses to contact", where + ": pool.behind",
                "leave `pool.safeguarded` out, or what runs behind the network");
  if (!teacher_work(options.objective).any() && samples.simulated_share == 0 && pool.behind == BehindNetwork::nothing)
    return;
  if (samples.sample_materials == MaterialSampling::vertex)
    throw Error("the solver has one material for each cloth, and no materials by vertex",
                where + ": samples.sample_materials", "take `garment` or `none`, or a training without the solver");
  if (options.teacher.uses > 1 && teacher_work(options.objective).potential)
    throw Error("the solver's potential cannot be kept with a state", where + ": teacher.uses",
                "leave `objective.potential` out, or `teacher.uses`");
  if (options.teacher.uses > 1 && options.teacher.kept < options.optimiser.batch)
    throw Error("a step takes more samples than states are kept", where + ": teacher.kept",
                "give at least `optimiser.batch`");
  if (samples.start == GarmentStart::cut)
    throw Error("the solver takes no garments without their intersecting triangles", where + ": samples.start",
                "take `skinned` or `untangle`, or a training without the solver");
}

void read_over_base(const std::filesystem::path& file, const std::vector<std::string>& overrides, int depth,
                    TrainingOptions& options) {
  const Config config = read_config(file, training_options().section, overrides);
  if (const Config& base = config["base"]; base.given) {
    if (depth > 8) base.fail("leads back to this file", "let the first file have no base");
    read_over_base(existing_path(base, file.parent_path()), {}, depth + 1, options);
  }
  read_options(training_options().rows, config, options);
  const PathsOfFile paths{file.parent_path(), options.samples.folder};
  const Config& samples = config["samples"];
  if (samples["people"].given) settle_people(paths, options.samples.people);
  if (samples["split"].given) settle_split(paths.folder, samples["split"]["file"], options.samples.split);
  if (const Config& weights = config["weights"]; weights.given && !weights.words.empty())
    options.weights = paths.seen(weights);
}

}  // namespace

const Options<TrainingOptions>& training_options() {
  using O = TrainingOptions;
  static const Options<O> table(
      "training", "The whole file.",
      {text("description", "Free text for readers."),
       path("base", "Training file whose values apply where this one gives none. The path is relative to this file."),
       text("name", &O::name, "Name of the run. Default: that of the file."),
       word("architecture", &O::architecture, preset_names(), "Architecture of the network."),
       integer("width", &O::width, {.low = 0, .high = most_latents},
               "Width of the latent vectors. 0: the architecture's own."),
       integer("message_steps", &O::message_steps, {.low = 0, .high = most_message_steps},
               "Number of message passing steps. 0: the architecture's own."),
       number("contour_force", &O::contour_force, Unit::none, not_negative,
              "Weight of intersection contours in the force that is an input of the network [N/m]. 0: they have no "
              "part in it."),
       path("weights", &O::weights,
            "Weights of an earlier stage to start from. The path is relative to this file. Default: random weights."),
       integer("seed", &O::seed, not_negative, "Seed of all random numbers of the run."),
       integer("steps", &O::steps, at_least_one, "Number of optimiser steps in all."),
       choice("device", &O::device, network_devices(),
              "What computes the network forward and backward, as `learned.device` of a scene. The rest of a step "
              "stays on the CPU. A run may be resumed with another device."),
       section(&O::samples, sample_options(), "What the network is trained on."),
       section(&O::pool, pool_options(), "How states are rolled out."),
       section(&O::contact, training_contact_options(), "Pairs of cloth with cloth."),
       section(&O::space, space_options(), "World edges between cloth vertices."),
       section(&O::objective, objective_options(), "Terms of the loss."),
       section(&O::teacher, teacher_options(), "The solver as teacher."),
       section(&O::optimiser, optimiser_options(), "Optimiser and learning rate."),
       section(&O::watch, watch_options(), "Checkpoints and measurements.")});
  return table;
}

std::vector<std::string> training_clip_names(const SampleOptions& samples) {
  if (!samples.clips.empty()) return samples.clips;
  std::vector<std::string> names;
  for (const ClipEntry& entry : read_clip_split(config_folder() / "clips.yaml"))
    if (!entry.validation) names.push_back(entry.name);
  return names;
}

bool has_mannequin(const SampleOptions& samples) { return samples.garments != std::vector<std::string>{"none"}; }

TrainingOptions read_training(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  TrainingOptions options;
  options.samples.folder = std::filesystem::absolute(file).parent_path().lexically_normal();
  read_over_base(file, overrides, 0, options);
  if (options.name.empty()) options.name = file.stem().string();
  if (options.optimiser.batch > options.pool.states)
    throw Error(fmt::format("takes {} samples in a step, and the pool has {} states", options.optimiser.batch,
                            options.pool.states),
                file.string() + ": optimiser.batch", "give `pool.states` at least as many");
  check_names(options, file.string());
  check_solver(options, file.string());
  return options;
}

std::string training_yaml(const TrainingOptions& options) { return to_yaml(training_options().written(options)); }

std::filesystem::path weights_path(const TrainingOptions& options) { return options.samples.folder / options.weights; }

TrainingOptions with_absolute_paths(TrainingOptions options) {
  if (!options.weights.empty()) options.weights = weights_path(options).lexically_normal().string();
  options.samples.people = with_absolute_paths(std::move(options.samples.people), options.samples.folder);
  return options;
}

std::string training_reference() {
  std::string page = chapters_below(training_options().section);
  page +=
      "### Terms of the objective\n\nEach has two columns in `steps.csv`: its weighted value [J], and `_share`, its "
      "share of "
      "the gradient.\n\n| term | weight | what is summed up |\n|---|---|---|\n";
  for (const LossRow& row : loss_rows())
    page += fmt::format("| `{}` | `objective.{}` | {} |\n", row.name, row.weighs, row.about);
  return page;
}

TeacherWork teacher_work(const LossOptions& options) { return {is_used(options.targets), is_used(options.potential)}; }

std::vector<std::string> unfinished_ramps(const TrainingOptions& options) {
  std::vector<std::string> complaints;
  const auto check = [&](const std::string& name, const LossRamp& ramp) {
    if (ramp.begin <= ramp.end && ramp.end <= 0.9) return;
    complaints.push_back(
        fmt::format("{} goes from {} to {} between {} and {} of the run: it must stand at its full "
                    "value for the last tenth",
                    name, ramp.from, ramp.to, ramp.begin, ramp.end));
  };
  check("pool.frames", options.pool.frames);
  for (const LossRow& row : loss_rows()) check("objective." + std::string(row.weighs), row.weight(options.objective));
  complaints.erase(std::ranges::unique(complaints).begin(), complaints.end());  // terms may share a weight
  return complaints;
}

}  // namespace selvedge

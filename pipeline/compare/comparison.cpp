#include "pipeline/compare/comparison.hpp"

#include <algorithm>

#include "pipeline/config/options.hpp"

namespace selvedge {
namespace {

using namespace table;

const Options<CompareScene>& compared_scene_options() {
  using O = CompareScene;
  static const Options<O> table(
      "compared_scene", "",
      {needed(path("file", "Scene file, relative to this file's folder.")),
       text("name", "Name of the scene. Default: that of the file."),
       texts("set", &O::overrides, "`key=value` overrides of the scene."),
       integer("states", &O::states, not_negative,
               "Number of common states, spread over the run. 0: no references are made, and no errors measured."),
       integer("horizon", &O::horizon, at_least_one, "Number of frames from each common state."),
       text("group", &O::outfit, "Group of the scene in an evaluation, such as its garment.")},
      "file");
  return table;
}

const Section& setting_section() {
  static const Section table{
      "setting",
      "",
      {needed(text("name", "Name of the row.")), text("stepper", "Stepper, in place of the scene's."),
       text("weights", "File in `weights_folder`. A row whose file is not there is left out, and says so."),
       texts("set", "`key=value` overrides of every scene.")}};
  return table;
}

const Options<SequenceOptions>& sequence_options() {
  using O = SequenceOptions;
  static const Options<O> table(
      "sequences", "Outfits on clips, each a scene. The tangled ones start where training's third stage starts.",
      {text("file", &O::file, "Scene of an outfit on a body `person`, relative to this file's folder."),
       texts("outfits", &O::outfits, "Outfits of outfits.yaml."),
       texts("clips", &O::clips, "Procedural clips. Each outfit goes through each in turn."),
       integer("count", &O::count, not_negative, "Number of sequences. With `training`, 0: all that there are."),
       integer("tangled", &O::tangled, not_negative,
               "Number of sequences that start tangled: every second one up to this number, or all."),
       integer("frames", &O::frames, at_least_one, "Number of frames of a sequence."),
       integer("seed", &O::seed, not_negative, "Seed of tangled starts."),
       number("shape_spread", &O::shape_spread, Unit::none, not_negative,
              "Standard deviation of the shape coefficients of bodies in tangled sequences. None goes beyond 3."),
       text("training", &O::training,
            "Training file, relative to this file's folder. The sequences are those of its people whom `split` names, "
            "in place of outfits and clips."),
       word("split", &O::split, {"training", "validation", "test"},
            "Split of `training`. The person, the clip or what is worn belongs to it, and none of them to a later "
            "one.")});
  return table;
}

const Options<ComparedDrapes>& compared_drapes_options() {
  using O = ComparedDrapes;
  static const Options<O> table(
      "compared_drapes", "",
      {needed(text("run", "Folder of a finished `selvedge train` of drapes, relative to the working folder.")),
       text("name", &O::name, "Name of the training. Default: that of the folder."),
       choice("of", &O::use,
              {{"garments", DrapesUse::garments}, {"gcnn", DrapesUse::graph_network}, {"clips", DrapesUse::clips}},
              "Tables that show the training: those of garments, of graph networks, or of unseen clips."),
       flag("counted", &O::counted, "True: the training counts in the means over all garments.")},
      "run");
  return table;
}

const Options<EvaluationOptions>& evaluation_options() {
  using O = EvaluationOptions;
  static const Options<O> table(
      "evaluation", "Tables of what rows leave of intersections, with paired intervals.",
      {text("baseline", &O::baseline, "Row that the others are compared with. Default: there is no evaluation."),
       integer("resamples", &O::resamples, at_least_one, "Number of resamples of the bootstrap."),
       flag("volume", &O::volume,
            "True: the volume that self-penetrating cloth encloses is measured too, in the runs that are kept "
            "(`keep_runs`)."),
       integer("left_frames", &O::left_frames, at_least_one,
               "Number of frames in the plot of the part of the first pairs that is left.")});
  return table;
}

const Options<RowLimits>& row_limit_options() {
  using O = RowLimits;
  static const Options<O> table(
      "limits", "When a row ends before its last frame. It stays in table and plot, marked, with what was measured.",
      {integer(
           "pairs", &O::pairs, not_negative,
           "Largest number of intersecting pairs of cloth for each triangle, at the end of a frame. 0: any number."),
       number("seconds", &O::seconds, Unit::time, not_negative,
              "Longest time of a run, measuring included, and of all frames of a row from the common states. 0: any "
              "time. Where it ends a row depends on the machine.")});
  return table;
}

const Options<Comparison>& comparison_options() {
  using O = Comparison;
  static const Options<O> table(
      "comparison", "The whole file.",
      {text("description", "Free text for readers."),
       sections("scenes", compared_scene_options().section, "[]",
                "Scenes: at least one, unless there are sequences or drapes."),
       sections("drapes", compared_drapes_options().section, "[]", "Trainings for the tables of the repulsive layer."),
       section(&O::sequences, sequence_options(), ""), section(&O::evaluation, evaluation_options(), ""),
       section(&O::limits, row_limit_options(), ""),
       text("weights_folder", &O::weights_folder, "Folder of the settings' weights, relative to this file's folder."),
       integer("keep_runs", &O::keep_runs, not_negative,
               "Number of scenes of which the trajectories of the rows' first repeats are kept, with a page that plays "
               "them."),
       needed(sections("settings", setting_section(), "", "Rows: at least one.")),
       texts("reference", &O::reference, "`key=value` overrides of the temporal reference, beside its time step."),
       texts("algebraic", &O::algebraic,
             "`key=value` overrides of the algebraic reference, beside its one step a frame and its tolerances."),
       integer("judged_frames", &O::judged_frames, not_negative,
               "Number of frames of a run whose distance to the optimum is found."),
       integer("repeats", &O::repeats, at_least_one, "Number of timed runs of each setting."),
       number("jitter", &O::jitter, Unit::none, not_negative,
              "Size of the random displacements of common states by which the floor of errors is found, in mean edge "
              "lengths."),
       texts("short_form", "`key=value` overrides of this file that make it shorter (`--short`).")});
  return table;
}

template <class Named>
void check_names(const Config& list, const std::vector<Named>& all) {
  const std::vector<std::string> names = names_of(all);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const bool controls = std::ranges::any_of(names[k], [](unsigned char c) { return c < ' '; });
    if (controls || names[k].find('/') != std::string::npos)
      list.items[k].fail("has the name `" + names[k] + "`, which no file can have", "leave `/` and line breaks out");
    if (std::ranges::find(names, names[k]) != names.begin() + static_cast<std::ptrdiff_t>(k))
      list.items[k].fail("has the name `" + names[k] + "` of another", "give every one its own name");
  }
}

CompareSetting read_setting(const Config& item, const std::filesystem::path& weights_folder) {
  CompareSetting setting{item["name"].text(), {}, {}, {}};
  if (item["stepper"].given) {
    setting.stepper = item["stepper"].text();
    setting.overrides.push_back("run.stepper=" + setting.stepper);
  }
  if (item["weights"].given) {
    setting.weights = std::filesystem::absolute(weights_folder / item["weights"].text());
    setting.overrides.push_back("run.learned.weights=" + quoted_yaml(setting.weights.string()));
  }
  const std::vector<std::string>& more = item["set"].words;
  setting.overrides.insert(setting.overrides.end(), more.begin(), more.end());
  return setting;
}

}  // namespace

Comparison read_comparison(const std::filesystem::path& file, bool short_form,
                           const std::vector<std::string>& overrides) {
  Config config = read_config(file, comparison_options().section, overrides);
  if (short_form && !config["short_form"].words.empty()) {
    std::vector<std::string> all = config["short_form"].words;
    all.insert(all.end(), overrides.begin(), overrides.end());
    config = read_config(file, comparison_options().section, all);
  }
  Comparison comparison = comparison_options().read(config);
  comparison.file = file;
  for (const Config& item : config["scenes"].items) {
    CompareScene scene = compared_scene_options().read(item);
    scene.file = file.parent_path() / item["file"].text();
    if (!std::filesystem::exists(scene.file))
      item["file"].fail("names the missing file " + scene.file.string(), "paths are relative to the comparison's file");
    scene.name = item["name"].given ? item["name"].text() : scene.file.stem().string();
    comparison.scenes.push_back(std::move(scene));
  }
  const std::filesystem::path folder = file.parent_path() / comparison.weights_folder;
  for (const Config& item : config["settings"].items) comparison.settings.push_back(read_setting(item, folder));
  for (const Config& item : config["drapes"].items) {
    ComparedDrapes one = compared_drapes_options().read(item);
    one.run = item["run"].text();
    if (one.name.empty()) one.name = one.run.filename().string();
    comparison.drapes.push_back(std::move(one));
  }
  check_names(config["drapes"], comparison.drapes);
  check_names(config["scenes"], comparison.scenes);
  check_names(config["settings"], comparison.settings);
  if (comparison.settings.empty()) config["settings"].fail("is empty", "give at least one");
  const bool sequences = comparison.sequences.count > 0 || !comparison.sequences.training.empty();
  if (comparison.scenes.empty() && !sequences && comparison.drapes.empty())
    config["scenes"].fail("is empty", "give at least one, or `sequences`, or `drapes`");
  const std::string& baseline = comparison.evaluation.baseline;
  const std::vector<std::string> settings = names_of(comparison.settings);
  if (!baseline.empty() && std::ranges::find(settings, baseline) == settings.end())
    config["evaluation"]["baseline"].fail("names `" + baseline + "`, which is no setting",
                                          "settings: " + joined(settings) + suggestion(baseline, settings));
  return comparison;
}

}  // namespace selvedge

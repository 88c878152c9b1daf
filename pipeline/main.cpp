#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>

#include "collision/geometry/error.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/dataset_command.hpp"
#include "pipeline/commands/train_command.hpp"
#include "pipeline/commands/weights_commands.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/host/process_threads.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/scene/kinds.hpp"

using namespace selvedge;

namespace {

// What the command line asked for; empty until a command has been parsed.
using Chosen = std::function<int()>;

// Adds a command with its own copy of `Arguments`, which `options` binds and `run` gets with the --json flag.
template <class Arguments, class Options, class Run>
void add_command(CLI::App& app, Chosen& chosen, const char* name, const char* about, Options options, Run run) {
  CLI::App* command = app.add_subcommand(name, about);
  const auto arguments = std::make_shared<Arguments>();
  const auto json = std::make_shared<bool>(false);
  options(*command, *arguments);
  command->add_flag("--json", *json, "one JSON object on standard output, people's text on standard error");
  command->callback([&chosen, arguments, json, run] { chosen = [=] { return run(*arguments, *json); }; });
}

void scene_options(CLI::App& command, SceneArguments& arguments) {
  command.add_option("scene", arguments.scene, "scene file (YAML)")->required();
  command.add_option("--set", arguments.overrides, "key=value instead of the scene's, dotted keys")
      ->allow_extra_args(false);
  command.add_option("--stepper", arguments.stepper, joined(known_kinds().names()));
  command.add_option("--weights", arguments.weights, "weight file of the steppers `learned` and `hybrid`");
  command.add_option("--device", arguments.device, "that runs their network: cpu, libtorch, cuda or auto");
}

void simulate_options(CLI::App& command, SimulateArguments& arguments) {
  scene_options(command, arguments.scene);
  command.add_option("--out", arguments.out,
                     "folder for the results (the scene's output.folder, or out/NAME-OF-SCENE)");
  command.add_flag("--resume", arguments.resume, "go on from the checkpoint of an interrupted run");
  command.add_flag("!--no-view", arguments.view, "do not make the page");
}

void check_options(CLI::App& command, CheckRequest& request) {
  command.add_option("file", request.file, "mesh (.obj, .ply) or trajectory (.h5)")->required();
  command.add_option("--rest", request.rest, "mesh of the same faces at rest, for the stretches");
  command.add_option("--body", request.bodies, "mesh that must not be touched; may be given again")
      ->allow_extra_args(false);
  command.add_option("--against", request.against, "trajectory of the same cloths: measures of papers against it");
  command.add_option("--audit", request.audit, "own, or fcl: FCL's opinion beside it")
      ->check(CLI::IsMember({"own", "fcl"}));
  command.add_option("--horizon", request.horizon, "largest gap looked for [m]")->check(CLI::PositiveNumber);
  command.add_flag("--volume", request.volume, "the volume that crossings enclose, holes being closed");
}

void untangle_options(CLI::App& command, UntangleRequest& request) {
  command.add_option("file", request.file, "mesh (.obj, .ply)")->required();
  command.add_option("--out", request.out, "where the untangled mesh goes (.obj, .ply)")->required();
  command.add_option("--body", request.bodies, "mesh to part from, stands still; may be given again")
      ->allow_extra_args(false);
  command.add_option("--unit", request.unit, "of the coordinates: m, dm, cm, mm");
  command.add_option("--layers", request.layers, "one number a piece of cloth, the innermost lowest")->delimiter(',');
  command.add_option("--iterations", request.iterations, "at most")->check(CLI::PositiveNumber);
}

void push_options(CLI::App& command, PushRequest& request) {
  command.add_option("file", request.file, "garment (.obj, .ply), in metres")->required();
  command.add_option("--body", request.body, "mesh to push it out of")->required();
  command.add_option("--truth", request.truth, "mesh of the garment's faces that the result is compared with");
  command.add_option("--out", request.out, "where the pushed garment goes (.obj, .ply)");
  command.add_option("--method", request.method, "layer, smooth (a least-squares displacement) or none")
      ->check(CLI::IsMember({"layer", "smooth", "none"}));
  command.add_option("--shape", request.shape, "of a body that passes through itself")
      ->check(CLI::IsMember({"union", "raw"}));
  command.add_option("--alpha", request.alpha, "the layer's scale")->check(CLI::NonNegativeNumber);
  command.add_option("--margin", request.margin, "added to each push [m]")->check(CLI::NonNegativeNumber);
  command.add_option("--recheck", request.recheck, "so often pushed vertices are asked again")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--edge-pass", request.edge_pass, "rounds that lift crossing edges")
      ->check(CLI::NonNegativeNumber);
}

void dress_options(CLI::App& command, DressRequest& request) {
  command.add_option("mesh", request.mesh, "garment where the body wears it (.obj, .ply)")->required();
  command.add_option("--out", request.out, "the garment for scenes (.h5)")->required();
  command.add_option("--unit", request.unit, "of the coordinates: m, dm, cm, mm");
  command.add_option("--body", request.body, "mannequin, or a file (.npz, .h5)");
  command.add_option("--shape", request.shape, "of that body: coefficients")->delimiter(',');
  command.add_option("--pose", request.pose, "clip that the body stands in: a name, .bvh or .npz (zero pose)");
  command.add_option("--time", request.time, "of the clip [s]");
  command.add_option("--rotate", request.rotations, "JOINT=x,y,z: its rotation in that pose, axis times angle [rad]")
      ->allow_extra_args(false);
  command.add_option("--fit", request.fit, "tight: weights of the nearest vertex; loose: averaged")
      ->check(CLI::IsMember({"tight", "loose"}));
  command.add_option("--pin", request.pins, "group that stays with the body, or none; may be given again")
      ->allow_extra_args(false);
}

void pattern_options(CLI::App& command, PatternRequest& request) {
  command.add_option("pattern", request.file, "pattern of GarmentCode (*_specification.json)")->required();
  command.add_option("--out", request.out, "the garment for scenes (.h5), or its mesh alone (.obj, .ply)")->required();
  command.add_option("--body", request.body, "mannequin, a body (.npz, .h5) or a mesh in metres (.obj, .ply)");
  command.add_option("--edge", request.edge, "length of the triangles' edges [m]")->check(CLI::Range(0.002, 0.2));
  command.add_option("--material", request.material, "of the cloth: a name, as in scenes");
  command.add_option("--pin", request.pins, "group that stays with the body in scenes; may be given again")
      ->allow_extra_args(false);
  command.add_option("--record", request.record, "trajectory of the sewing (.h5)");
  command.add_flag("--flat", request.flat, "only cut: the panels as a mesh");
}

void body_options(CLI::App& command, BodyRequest& request) {
  command
      .add_option("file", request.file,
                  "mesh (.obj, .ply), model of the SMPL family (.npz) or glTF with a skin (.glb, .gltf)")
      ->required();
  command.add_option("--skeleton", request.skeleton, "of the mesh, as MakeHuman has it (.mhskel)");
  command.add_option("--weights", request.weights, "of the mesh, as MakeHuman has them (.mhw)");
  command.add_option("--joints", request.joints, "where the joints of a mesh are that has neither (.yaml)");
  command.add_option("--unit", request.unit, "of the mesh: m, dm, cm, mm");
  command
      .add_option("--mesh", request.meshes.only, "mesh of glTF, or group, that becomes the body; may be given again")
      ->allow_extra_args(false);
  command.add_option("--without", request.meshes.without, "mesh or group that does not; may be given again")
      ->allow_extra_args(false);
  command.add_option("--out", request.out, "where the body goes (.h5)")->required();
}

void ccd_options(CLI::App& command, CcdArguments& arguments) {
  command
      .add_option("files", arguments.files, "queries with known answers (.csv), in folders edge-edge or vertex-face")
      ->required();
}

void fit_options(CLI::App& command, FitRequest& request) {
  command.add_option("run", request.run, "trajectory (.h5), or the folder of a run")->required();
  command.add_option("--scene", request.scene, "that it was made of (config.yaml beside it)");
  command.add_option("--body", request.body, "obstacle to fit (the first body)");
  command.add_option("--regions", request.regions, "of the body: vertices by name (.json); otherwise by its joints");
  command.add_option("--frame", request.frame, "the last one if left out")->check(CLI::NonNegativeNumber);
  command.add_option("--reach", request.reach, "what is nearer touches the skin [m]")->check(CLI::PositiveNumber);
  command.add_option("--out", request.out, "page, coloured (.html)");
}

void export_options(CLI::App& command, ExportRequest& request) {
  command.add_option("trajectory", request.trajectory, "run.h5")->required();
  command.add_option("--format", request.format, "obj, ply, pc2, mdd, glb, usda or xdmf");
  command.add_option("--out", request.out, "folder")->default_val("export");
  command.add_flag("--obstacles", request.obstacles, "also the obstacles");
}

void view_options(CLI::App& command, ViewArguments& arguments) {
  command.add_option("runs", arguments.runs, "trajectories, shown side by side")->required();
  command.add_option("--out", arguments.out, "HTML file");
}

void bench_options(CLI::App& command, BenchRequest& request) {
  command.add_option("--sizes", request.sizes, "vertices along a side")->delimiter(',');
  command.add_option("--scenes", request.scenes, "hang, drop, tube")->delimiter(',');
  command.add_option("--only", request.only, "of the parts detection, engine, training, scenes")
      ->delimiter(',')
      ->check(CLI::IsMember({"detection", "engine", "training", "scenes"}));
  command.add_option("--frames", request.frames, "instead of the scenes' own");
  command.add_option("--configs", request.configs, "folder of the scenes");
  command.add_option("--out", request.out, "folder for the results");
}

void stress_options(CLI::App& command, StressRequest& request) {
  command.add_option("scenes", request.scenes, "names of scenes (all)");
  command.add_option("--repeats", request.repeats, "runs of each scene")->check(CLI::PositiveNumber);
  command.add_option("--seed", request.seed, "of the first repeat's jitter");
  command.add_option("--jitter", request.jitter, "of the starts, in mean edge lengths")->check(CLI::NonNegativeNumber);
  command.add_flag("--short", request.short_form, "the scenes' short forms");
  command.add_option("--configs", request.configs, "folder of the scenes");
  command.add_option("--out", request.out, "folder for the results");
}

void compare_options(CLI::App& command, CompareRequest& request) {
  command.add_option("comparison", request.file, "comparison file (YAML)")->required();
  command.add_flag("--short", request.short_form, "the short forms of the comparison and its scenes");
  command.add_option("--set", request.overrides, "key=value instead of the comparison file's, dotted keys")
      ->allow_extra_args(false);
  command.add_option("--out", request.out, "folder for the results");
}

void validate_options(CLI::App& command, ValidateRequest& request) {
  command.add_option("cases", request.cases, "names of cases (all)");
  command.add_option("--set", request.overrides, "parameter=value[,value...] instead of the cases' own")
      ->allow_extra_args(false);
  command.add_flag("--short", request.short_form, "the cases' short lists of parameters");
  command.add_option("--out", request.out, "folder for the results");
}

void stability_options(CLI::App& command, StabilityRequest& request) {
  command.add_option("suite", request.suite, "suite file (configs/stability.yaml)");
  command.add_option("--case", request.cases, "names of cases (all)")->allow_extra_args(false);
  command.add_option("--stepper", request.stepper, "in place of the scenes' own");
  command.add_option("--weights", request.weights, "weight file of the steppers `learned` and `hybrid`");
  command.add_flag("--short", request.short_form, "the runs that the suite marks as short");
  command.add_option("--out", request.out, "folder for the results");
}

void wardrobe_options(CLI::App& command, WardrobeRequest& request) {
  command.add_option("wear", request.wear, "names of garments and outfits by code (all)");
  command.add_option("--clips", request.clips, "names of procedural clips (all)")->delimiter(',');
  command.add_option("--frames", request.most_frames, "of a clip at most")->check(CLI::PositiveNumber);
  command.add_option("--share", request.share, "K N: every Nth clip from the Kth on, for several processes at once");
  command.add_option("--configs", request.configs, "folder of the configurations");
  command.add_option("--out", request.out, "folder for the results");
}

void dataset_options(CLI::App& command, DatasetRequest& request) {
  command.add_option("config", request.config, "data file (YAML), see docs/repulsion.md")->required();
  command.add_option("--set", request.overrides, "key=value instead of the file's, dotted keys")
      ->allow_extra_args(false);
  command.add_option("--out", request.out, "folder for the drapes (out/data/NAME)");
}

void train_options(CLI::App& command, TrainArguments& arguments) {
  command.add_option("config", arguments.config, "training file (YAML), see docs/training.md")->required();
  command.add_option("--set", arguments.overrides, "key=value instead of the file's, dotted keys")
      ->allow_extra_args(false);
  command.add_option("--out", arguments.out, "folder for weights, checkpoint and tables (out/training/NAME)");
  command.add_flag("--resume", arguments.resume, "go on from the folder's checkpoint");
  command.add_flag("--pause", arguments.pause, "ask the run in the folder to stop at a checkpoint");
}

void weights_import_options(CLI::App& command, WeightsImportArguments& arguments) {
  command.add_option("checkpoint", arguments.checkpoint, "published by the authors of HOOD or ContourCraft (.pth)")
      ->required();
  command.add_option("--out", arguments.out, "where the weight file goes (.h5)")->required();
}

void info_options(CLI::App& command, InfoArguments& arguments) {
  command.add_option("--keys", arguments.keys, "user: what most scenes need; expert: all other keys of scene files")
      ->check(CLI::IsMember({"user", "expert"}));
}

void weights_info_options(CLI::App& command, WeightsInfoArguments& arguments) {
  command.add_option("file", arguments.file, "weight file (.h5)")->required();
}

void weights_halve_options(CLI::App& command, WeightsHalveArguments& arguments) {
  command.add_option("file", arguments.file, "weight file (.h5)")->required();
  command.add_option("--out", arguments.out, "where the weight file of half the size goes (.h5)")->required();
}

void weights_parity_options(CLI::App& command, WeightsParityArguments& arguments) {
  command.add_option("file", arguments.file, "weight file (.h5) or published checkpoint (.pth)")->required();
  command.add_option("dump", arguments.dump, "a step that the authors' code took (.npz)")->required();
}

void add_weights_commands(CLI::App& app, Chosen& chosen) {
  CLI::App& weights = *app.add_subcommand("weights", "weight files of learned steppers");
  weights.require_subcommand(1);
  add_command<WeightsImportArguments>(weights, chosen, "import", "a weight file from a published checkpoint",
                                      weights_import_options, weights_import_command);
  add_command<WeightsInfoArguments>(weights, chosen, "info", "what is in a weight file", weights_info_options,
                                    weights_info_command);
  add_command<WeightsHalveArguments>(weights, chosen, "halve", "a weight file stored as 16-bit floats",
                                     weights_halve_options, weights_halve_command);
  add_command<WeightsParityArguments>(weights, chosen, "parity", "our step beside one that the authors' code took",
                                      weights_parity_options, weights_parity_command);
}

void add_commands(CLI::App& app, Chosen& chosen) {
  add_command<SimulateArguments>(app, chosen, "simulate", "a scene in, an audited trajectory out", simulate_options,
                                 simulate_command);
  add_command<SceneArguments>(app, chosen, "plan", "what a scene needs, what is left out, and why", scene_options,
                              plan_command);
  add_command<CheckRequest>(app, chosen, "check", "audit a mesh or a trajectory", check_options, check_command);
  add_command<UntangleRequest>(app, chosen, "untangle", "part a cloth from itself and from bodies", untangle_options,
                               untangle_command);
  add_command<PushRequest>(app, chosen, "push", "push a garment out of a body and measure both", push_options,
                           push_command);
  add_command<DressRequest>(app, chosen, "dress", "a garment for scenes from a mesh that a body wears", dress_options,
                            dress_command);
  add_command<PatternRequest>(app, chosen, "pattern", "a sewing pattern, sewn and draped on a body", pattern_options,
                              pattern_command);
  add_command<BodyRequest>(app, chosen, "body", "a rigged body from other programs' files, for scenes", body_options,
                           body_command);
  add_command<CcdArguments>(app, chosen, "ccd", "continuous detection against queries with known answers", ccd_options,
                            ccd_command);
  add_command<FitRequest>(app, chosen, "fit", "ease, strain and pressure by region of the body", fit_options,
                          fit_command);
  add_command<ExportRequest>(app, chosen, "export", "a trajectory as meshes, point caches, glTF or USD", export_options,
                             export_command);
  add_command<ViewArguments>(app, chosen, "view", "one page that plays trajectories in a browser", view_options,
                             view_command);
  add_command<BenchRequest>(app, chosen, "bench", "the benchmark family", bench_options, bench_command);
  add_command<StressRequest>(app, chosen, "stress", "scenes that must end clean and come out as they say",
                             stress_options, stress_command);
  add_command<CompareRequest>(app, chosen, "compare", "settings against references: error against run time",
                              compare_options, compare_command);
  add_command<ValidateRequest>(app, chosen, "validate", "physics with known answers", validate_options,
                               validate_command);
  add_command<StabilityRequest>(app, chosen, "stability", "stiff and extreme cases, pass or fail each",
                                stability_options, stability_command);
  add_command<WardrobeRequest>(app, chosen, "wardrobe", "every garment by code through every procedural clip",
                               wardrobe_options, wardrobe_command);
  add_command<DatasetRequest>(app, chosen, "dataset", "drapes at rest to train a network on", dataset_options,
                              dataset_command);
  add_command<TrainArguments>(app, chosen, "train", "a network of the stepper `learned`, or one of drapes",
                              train_options, train_command);
  add_weights_commands(app, chosen);
  add_command<InfoArguments>(app, chosen, "info", "versions, packages, threads; keys of scene files", info_options,
                             info_command);
}

// The headings of `selvedge --help`; a command that stands under none is one for use.
void group_commands(CLI::App& app) {
  const std::vector<std::string> prepared{"plan",  "body",     "dress", "pattern", "dataset",
                                          "train", "untangle", "push",  "weights"};
  const std::vector<std::string> measured{"ccd", "bench", "stress", "compare", "validate", "stability", "wardrobe"};
  for (CLI::App* command : app.get_subcommands({})) {
    const auto is_in = [&](const auto& names) { return std::ranges::find(names, command->get_name()) != names.end(); };
    command->group(is_in(prepared) ? "Prepare" : is_in(measured) ? "Measure" : "Use");
  }
}

// What is wrong with the command line, in the form of every other error.
std::string refusal(const CLI::App& app, const CLI::ParseError& problem, int argc, char** argv) {
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  const std::string word = argc > 1 ? argv[1] : "";
  const bool is_command = std::ranges::find(known, word) != known.end();
  const Error error = is_command ? Error(problem.what(), word, "`selvedge " + word + " --help` lists what it takes")
                      : word.empty() || word[0] == '-'
                          ? Error(problem.what(), "the command line", "`selvedge --help` lists the commands")
                          : Error("there is no command `" + word + "`" + suggestion(word, known), "the command line",
                                  "`selvedge --help` lists the commands");
  return "selvedge: " + std::string(error.what()) + "\n";
}

}  // namespace

// Exit status: 0 well, 1 the result is not clean, 2 bad input or a missing package.
int main(int argc, char** argv) {
  set_up_threads(argv);
  CLI::App app{"selvedge: a garment simulator with audited contact", "selvedge"};
  app.set_version_flag("--version", std::string(program_version()));
  app.require_subcommand(1);
  Chosen chosen;
  add_commands(app, chosen);
  group_commands(app);
  try {
    app.parse(argc, argv);
    return chosen();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help or version, which it prints
    std::cerr << refusal(app, error, argc, argv);
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "selvedge: " << error.what() << "\n";
    return 2;
  }
}

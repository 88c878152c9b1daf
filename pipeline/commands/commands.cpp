#include "pipeline/commands/commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "collision/geometry/stop_scope.hpp"
#include "pipeline/cells/scene_cells.hpp"
#include "pipeline/commands/command_output.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/host/folder_lock.hpp"
#include "pipeline/host/interrupt.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/resume.hpp"
#include "pipeline/run/run_inputs_yaml.hpp"
#include "pipeline/run/run_scene.hpp"
#include "pipeline/scene/kinds.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/tools/info.hpp"
#include "pipeline/tools/plan.hpp"
#include "pipeline/tools/scene_pages.hpp"
#include "pipeline/view/view.hpp"

namespace selvedge {
namespace {

struct SceneArguments {
  std::filesystem::path scene;
  std::vector<std::string> overrides;  // key=value
  std::optional<std::string> stepper;
  std::optional<std::filesystem::path> weights;  // of the stepper `learned`
  std::optional<std::string> device;             // that computes its network
};

struct SimulateArguments {
  SceneArguments scene;
  std::optional<std::filesystem::path> out;  // otherwise out/NAME-OF-SCENE
  std::string resume;                        // empty, "true", or "auto"
  bool view = true;
  bool cache = true;
};

Setup read_scene(const SceneArguments& arguments) {
  std::vector<std::string> overrides = arguments.overrides;
  if (arguments.stepper) overrides.push_back("run.stepper=" + *arguments.stepper);
  if (arguments.weights)
    overrides.push_back("run.learned.weights=" + quoted_yaml(std::filesystem::absolute(*arguments.weights).string()));
  if (arguments.device) overrides.push_back("run.learned.device=" + *arguments.device);
  Setup setup = read_setup(arguments.scene, overrides);
  const bool unread = arguments.weights && !reads_weights(setup);
  if (unread || (arguments.device && setup.kind.network == NetworkUse::none))
    setup.warnings.push_back(
        fmt::format("{} has no part in the stepper `{}`, which runs no network; --stepper learned "
                    "and --stepper hybrid do",
                    unread ? "--weights" : "--device", setup.run.stepper));
  return setup;
}

std::filesystem::path folder_for(const SimulateArguments& arguments, const Setup& setup) {
  if (arguments.out) return *arguments.out;
  if (!setup.run.output.empty()) return setup.run.output;
  return std::filesystem::path("out") / arguments.scene.scene.stem();
}

// Makes the page and says where it is, or why it is not.
std::string page_text(const std::filesystem::path& out, const RunSummary& summary) {
  if (summary.end == RunEnd::interrupted) return "not made of a run that was stopped: `selvedge view` makes one";
  const std::optional<std::string> trouble = write_page(out);
  return trouble ? "not made: " + *trouble : (out / "view.html").string();
}

std::string trajectory_line(const std::filesystem::path& out) {
  return fmt::format("{:<20}{}\n", "trajectory", (out / "run.h5").string());
}

// Where a run begins.
enum class Beginning { start, draping, checkpoint };

// A folder without a checkpoint may have a draped start that was stopped. Without `auto` a resumed run needs one of
// both.
Beginning beginning_of(const SimulateArguments& arguments, const Setup& setup, const std::filesystem::path& out) {
  if (arguments.resume.empty()) return Beginning::start;
  if (std::filesystem::exists(out / "checkpoint.h5")) return Beginning::checkpoint;
  if (setup.initial.frame < 0 && std::filesystem::exists(draping_file(out))) return Beginning::draping;
  return arguments.resume == "auto" ? Beginning::start : Beginning::checkpoint;
}

// What `--resume=auto` has chosen.
std::string beginning_text(Beginning begins, const std::filesystem::path& out) {
  switch (begins) {
    case Beginning::checkpoint:
      return "goes on from " + (out / "checkpoint.h5").string() + "\n";
    case Beginning::draping:
      return "goes on with the draped start of " + draping_file(out).string() + "\n";
    default:
      return "starts: nothing to go on from in " + out.string() + "\n";
  }
}

int simulate(const SimulateArguments& arguments, bool json) {
  const Setup setup = read_scene(arguments.scene);
  if (arguments.cache) read_tissue(cache_folder(), setup.bodies);
  warn_of_training();
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  for (const std::string& warning : run_warnings(setup, stepper->traits())) std::cerr << "warning: " << warning << "\n";
  Progress progress(std::cerr, isatty(STDERR_FILENO) != 0);
  const InterruptWatch watch;
  const std::filesystem::path out = folder_for(arguments, setup);
  make_folder(out);
  const FolderLock lock(out);
  const bool chooses = arguments.resume == "auto";
  if (const auto ended = chooses ? read_ended(out, run_inputs(setup)) : std::nullopt)
    return end_command(json, ended->text + trajectory_line(out), ended->summary, ended->clean);
  const Beginning begins = beginning_of(arguments, setup, out);
  if (chooses) people(json) << beginning_text(begins, out);
  std::optional<Start> start;
  if (begins != Beginning::checkpoint)
    start = prepare(setup, InterruptWatch::interrupted, &progress, InterruptWatch::interrupted,
                    KeptDraping{out, begins == Beginning::draping});
  if (begins != Beginning::checkpoint && !start) {
    people(json) << "stopped before the first frame; go on with --resume and the same arguments\n";
    return 1;
  }
  RunRequest request;
  request.out = out;
  request.locked = true;
  request.progress = &progress;
  request.stop = request.interrupt = InterruptWatch::interrupted;
  RunSummary summary;
  try {
    const StopScope scope(request.interrupt);
    summary = start ? run_scene(setup, *start, *stepper, request) : resume_scene(setup, *stepper, request);
  } catch (const Stopped&) {
    people(json) << "stopped before the first frame\n";
    return 1;
  }
  keep_tissue(setup, &std::cerr);
  people(json) << summary_text(summary) << trajectory_line(request.out);
  if (arguments.view) people(json) << fmt::format("{:<20}{}\n", "page to look at", page_text(request.out, summary));
  const std::string advice =
      summary.end == RunEnd::interrupted ? "go on with --resume and the same arguments\n" : std::string();
  return end_command(json, advice, summary_json(summary), is_clean(summary));
}

void add_scene_options(CLI::App& command, SceneArguments& arguments) {
  command.add_option("scene", arguments.scene, "scene file (YAML)")->required();
  add_overrides(command, arguments.overrides, "the scene's");
  command.add_option("--stepper", arguments.stepper, "method that makes the frames: " + joined(known_kinds().names()));
  command.add_option("--weights", arguments.weights,
                     "weight file of the steppers `learned`, `hybrid` and `carried_fitted`");
  command.add_option("--device", arguments.device, "device that computes the network: cpu, libtorch, cuda or auto");
}

}  // namespace

void add_overrides(CLI::App& command, std::vector<std::string>& overrides, const std::string& whose) {
  command
      .add_option("--set", overrides, "key=value, in place of " + whose + " value; keys are dotted; may be given again")
      ->allow_extra_args(false);
}

RunCommand simulate_command(CLI::App& command) {
  const auto arguments = std::make_shared<SimulateArguments>();
  add_scene_options(command, arguments->scene);
  command.add_option("--out", arguments->out,
                     "folder for the results; default: output.folder of the scene, or out/NAME-OF-SCENE");
  command
      .add_flag("--resume", arguments->resume,
                "continue an interrupted run from its checkpoint; auto: also start a run, or report one that has ended")
      ->check(CLI::IsMember({"true", "auto"}));
  command.add_flag("!--no-view", arguments->view, "make no page that plays the run");
  command.add_flag("!--no-cache", arguments->cache, "compute the soft tissue of bodies anew, and do not keep it");
  return [arguments](bool json) { return simulate(*arguments, json); };
}

RunCommand plan_command(CLI::App& command) {
  const auto arguments = std::make_shared<SceneArguments>();
  add_scene_options(command, *arguments);
  return [arguments](bool json) {
    const Setup setup = read_scene(*arguments);
    std::cout << (json ? plan_json(setup) : plan_text(setup));
    return 0;
  };
}

RunCommand info_command(CLI::App& command) {
  const auto keys = std::make_shared<std::string>();
  command
      .add_option("--keys", *keys, "print keys of scene files; user: those that most scenes need; expert: all others")
      ->check(CLI::IsMember({"user", "expert"}));
  return [keys](bool json) {
    std::cout << (!keys->empty() ? scene_keys_text(*keys == "user" ? KeyTier::user : KeyTier::expert)
                  : json         ? info_json()
                                 : info_text());
    return 0;
  };
}

}  // namespace selvedge

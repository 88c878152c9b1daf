#include <CLI/CLI.hpp>
#include <memory>

#include "pipeline/commands/command_output.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/number_checks.hpp"
#include "pipeline/drapes/make_drapes.hpp"
#include "pipeline/drapes/train_drapes.hpp"
#include "pipeline/host/interrupt.hpp"
#include "pipeline/processes/mpi_processes.hpp"
#include "pipeline/processes/together.hpp"
#include "pipeline/run/running_mark.hpp"
#include "pipeline/teach/teach_carried.hpp"
#include "pipeline/training/train.hpp"

namespace selvedge {
namespace {

struct TrainArguments {
  std::filesystem::path config;
  std::vector<std::string> overrides;  // key=value
  std::filesystem::path out;
  bool resume = false, pause = false;
};

struct TeachArguments {
  TeachRequest request;
  std::string kind;
};

std::string name_of_run(const TrainArguments& arguments) {
  return is_drape_training(arguments.config) ? read_drape_training(arguments.config, arguments.overrides).name
                                             : read_training(arguments.config, arguments.overrides).name;
}

// Trains in a process beside the first one, which says what came of it. A failure is the first one's status alone:
// where another process ended with one, mpirun would end the first one, perhaps before it has said what has failed.
int train_beside(const TrainRequest& request) {
  try {
    train_as_asked(request);
  } catch (const SharedFailure&) {
  }
  return 0;
}

}  // namespace

RunCommand dataset_command(CLI::App& command) {
  const auto request = std::make_shared<DatasetRequest>();
  command.add_option("config", request->config, "file that describes the drapes (YAML), see docs/repulsion.md")
      ->required();
  add_overrides(command, request->overrides, "the file\'s");
  command.add_option("--out", request->out, "folder for the drapes; default: out/data/NAME");
  return [request](bool json) {
    const InterruptWatch watch;
    const DatasetSummary summary = make_dataset(followed(*request));
    return end_command(json, dataset_text(summary) + stopped_text(summary.finished), dataset_json(summary),
                       summary.finished);
  };
}

RunCommand train_command(CLI::App& command) {
  const auto arguments = std::make_shared<TrainArguments>();
  command.add_option("config", arguments->config, "training file (YAML), see docs/training.md")->required();
  add_overrides(command, arguments->overrides, "the file\'s");
  command.add_option("--out", arguments->out, "folder for weights, checkpoint and tables; default: out/training/NAME");
  command.add_flag("--resume", arguments->resume, "continue from the checkpoint in the folder");
  command.add_flag("--pause", arguments->pause, "ask the run in the folder to stop at a checkpoint");
  return [arguments](bool json) {
    if (arguments->pause) {
      constexpr double longest_wait = 600;  // [s]
      const std::filesystem::path folder =
          arguments->out.empty() ? std::filesystem::path("out") / "training" / name_of_run(*arguments) : arguments->out;
      const bool paused = running_training() && pause_training(folder, longest_wait);
      people(json) << (paused ? "stopped at a checkpoint: " : "no training has answered in ") << folder.string()
                   << "\n";
      return paused ? 0 : 1;
    }
    std::unique_ptr<Processes> processes;
    try {
      processes = processes_of_mpirun();
    } catch (const Error&) {
      if (speaks_for_machine()) throw;
      return 0;
    }
    const InterruptWatch watch;
    TrainRequest request{arguments->config, arguments->overrides,        arguments->out, arguments->resume,
                         &std::cerr,        InterruptWatch::interrupted, processes.get()};
    if (processes && processes->rank() > 0) return train_beside(request);
    const RunningMark mark(arguments->config);
    if (mark.other()) std::cerr << "warning: another training runs: " << *mark.other() << "\n";
    const TrainedRun made = train_as_asked(request);
    const char* more = made.finished ? "" : "go on with --resume and the same arguments\n";
    return end_command(json, made.text + more, made.json, made.finished);
  };
}

RunCommand teach_command(CLI::App& command) {
  const auto arguments = std::make_shared<TeachArguments>();
  TeachRequest* request = &arguments->request;
  command.add_option("scene", request->scene, "scene file (YAML) of an outfit on a body")->required();
  command
      .add_option("--kind", arguments->kind,
                  "what is taught: carried, the coefficients of the stepper `carried_fitted`")
      ->required()
      ->check(CLI::IsMember({"carried"}));
  command.add_option("--clips", request->clips, "clips of the body to fit on")->required()->delimiter(',');
  command.add_option("--held-out", request->held_out, "clips of the body to measure on")->delimiter(',');
  command.add_option("--rounds", request->rounds, "in which the solver corrects what the fitted stepper makes")
      ->check(at_least_zero())
      ->capture_default_str();
  command.add_flag("--own", request->own, "a set of coefficients for each vertex, for this scene alone");
  command.add_option("--out", request->out, "file of coefficients (.h5)")->required();
  add_overrides(command, request->overrides, "the scene's");
  return [arguments](bool json) {
    const InterruptWatch watch;
    const TeachReport report = teach_carried(followed(arguments->request));
    const char* more = report.finished ? "" : "stopped; the same command starts again\n";
    return end_command(json, teach_text(report) + more, teach_json(report), report.finished);
  };
}

}  // namespace selvedge

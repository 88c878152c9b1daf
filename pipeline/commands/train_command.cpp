#include "pipeline/commands/train_command.hpp"

#include <iostream>

#include "pipeline/drapes/train_drapes.hpp"
#include "pipeline/host/interrupt.hpp"
#include "pipeline/training/running_mark.hpp"
#include "pipeline/training/train.hpp"

namespace selvedge {
namespace {

std::string name_of_run(const TrainArguments& arguments) {
  return is_drape_training(arguments.config) ? read_drape_training(arguments.config, arguments.overrides).name
                                             : read_training(arguments.config, arguments.overrides).name;
}

// Text and JSON of what was trained, and whether it has ended.
struct TrainedRun {
  std::string text, json;
  bool finished = false;
};
TrainedRun trained(const TrainRequest& request) {
  if (is_drape_training(request.config)) {
    const DrapeTrainSummary summary = train_drapes(request);
    return {drape_train_text(summary), drape_train_json(summary), summary.finished};
  }
  const TrainSummary summary = train(request);
  return {train_text(summary), train_json(summary), summary.finished};
}

}  // namespace

int train_command(const TrainArguments& arguments, bool json) {
  std::ostream& to = json ? std::cerr : std::cout;
  if (arguments.pause) {
    constexpr double longest_wait = 600;  // [s]
    const std::filesystem::path folder =
        arguments.out.empty() ? std::filesystem::path("out") / "training" / name_of_run(arguments) : arguments.out;
    const bool paused = running_training() && pause_training(folder, longest_wait);
    to << (paused ? "stopped at a checkpoint: " : "no training has answered in ") << folder.string() << "\n";
    return paused ? 0 : 1;
  }
  const InterruptWatch watch;
  const RunningMark mark(arguments.config);
  if (mark.other()) std::cerr << "warning: another training runs: " << *mark.other() << "\n";
  TrainRequest request{arguments.config, arguments.overrides, arguments.out,
                       arguments.resume, &std::cerr,          InterruptWatch::interrupted};
  const TrainedRun made = trained(request);
  to << made.text;
  if (!made.finished) to << "go on with --resume and the same arguments\n";
  if (json) std::cout << made.json;
  return made.finished ? 0 : 1;
}

}  // namespace selvedge

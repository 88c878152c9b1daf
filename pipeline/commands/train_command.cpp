#include "pipeline/commands/train_command.hpp"

#include <iostream>

#include "pipeline/host/interrupt.hpp"
#include "pipeline/training/running_mark.hpp"
#include "pipeline/training/train.hpp"

namespace selvedge {

int train_command(const TrainArguments& arguments, bool json) {
  std::ostream& to = json ? std::cerr : std::cout;
  if (arguments.pause) {
    constexpr double longest_wait = 600;  // [s]
    const std::filesystem::path folder =
        arguments.out.empty()
            ? std::filesystem::path("out") / "training" / read_training(arguments.config, arguments.overrides).name
            : arguments.out;
    const bool paused = running_training() && pause_training(folder, longest_wait);
    to << (paused ? "stopped at a checkpoint: " : "no training has answered in ") << folder.string() << "\n";
    return paused ? 0 : 1;
  }
  const InterruptWatch watch;
  const RunningMark mark(arguments.config);
  if (mark.other()) std::cerr << "warning: another training runs: " << *mark.other() << "\n";
  TrainRequest request{arguments.config, arguments.overrides, arguments.out,
                       arguments.resume, &std::cerr,          InterruptWatch::interrupted};
  const TrainSummary summary = train(request);
  to << train_text(summary);
  if (!summary.finished) to << "go on with --resume and the same arguments\n";
  if (json) std::cout << train_json(summary);
  return summary.finished ? 0 : 1;
}

}  // namespace selvedge

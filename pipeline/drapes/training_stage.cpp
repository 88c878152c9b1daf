#include "pipeline/drapes/training_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "collision/geometry/error.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/run/progress.hpp"

namespace selvedge {
namespace {

constexpr int lines_of_a_stage = 50;  // lines of its table

double rate_at(const StageOptions& options, long step) {
  const double part = static_cast<double>(step) / options.steps;
  return options.learning_rate * 0.5 * (1 + std::cos(std::numbers::pi * part));
}

void save(const StageRun& run, const TrainingStage& stage, const StageFile& at) {
  StageFile file = at, now = stage.state();
  file.parts = std::move(now.parts);
  file.numbers = std::move(now.numbers);
  write_stage_file(run.folder / (stage.name + ".h5"), file);
  write_file(run.folder / (stage.name + ".csv"), at.csv);
}

// A fresh stage, or the one in the folder.
StageFile begin_stage(const StageRun& run, const TrainingStage& stage) {
  const std::filesystem::path file = run.folder / (stage.name + ".h5");
  StageFile at;
  at.config = drape_training_yaml(run.options);
  at.csv = "step,seconds,rate," + stage.header + "\n";
  at.random = stream_of(run.options.seed, 1).state;
  if (!run.request.resume || !std::filesystem::exists(file)) return at;
  StageFile kept = read_stage_file(file);
  if (kept.config != at.config)
    throw Error("was trained with another configuration", file.string(), "begin anew, without --resume");
  stage.restore(kept);
  return kept;
}

}  // namespace

bool run_stage(StageRun& run, const TrainingStage& stage) {
  StageFile at = begin_stage(run, stage);
  const double before = at.seconds;
  const auto say = [&](const std::string& line) {
    if (run.request.log) *run.request.log << stage.name << ": " << line << std::endl;
  };
  const long every = std::max(1, stage.options.steps / lines_of_a_stage);
  Clock::time_point started = Clock::now(), saved = started, told = started;
  RandomStream random{at.random};
  while (at.step < stage.options.steps) {
    const double rate = rate_at(stage.options, at.step);
    const bool shown = (at.step + 1) % every == 0 || at.step + 1 == stage.options.steps || at.step == 0;
    const std::string line = stage.step(rate, random, shown);
    ++at.step;
    at.random = random.state;
    at.seconds = before + seconds_since(started);
    if (shown) at.csv += fmt::format("{},{:.1f},{:.4g},{}\n", at.step, at.seconds, rate, line);
    if (shown && (seconds_since(told) > 5 || at.step == stage.options.steps)) {
      told = Clock::now();
      say(fmt::format("step {} of {}, {}: {}", at.step, stage.options.steps, duration_text(at.seconds), line));
    }
    const bool stop = (run.request.stop && run.request.stop()) || std::filesystem::exists(pause_file(run.folder));
    if (stop || seconds_since(saved) > 60 * run.options.checkpoint_minutes) {
      save(run, stage, at);
      saved = Clock::now();
    }
    if (stop && at.step < stage.options.steps) return false;
  }
  save(run, stage, at);
  run.seconds += at.seconds;
  return true;
}

}  // namespace selvedge

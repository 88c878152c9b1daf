#include "pipeline/training/train.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "collision/geometry/floating_point.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/host/folder_lock.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/processes/learning_sums.hpp"
#include "pipeline/processes/together.hpp"
#include "pipeline/run/progress.hpp"
#include "pipeline/training/training_checkpoint_hdf5.hpp"
#include "pipeline/training/training_tables.hpp"

namespace selvedge {
namespace {

constexpr int lines_of_a_run = 200;  // lines of steps.csv

// A training in progress.
struct TrainingRun {
  explicit TrainingRun(const TrainRequest& asked) : request(asked) {}
  const TrainRequest& request;
  TrainingOptions options;
  std::filesystem::path folder;
  std::optional<FolderLock> lock;  // of the process that leads
  std::unique_ptr<Trainer> trainer;
  TrainingCounts counts;  // of all processes
  TrainingHistory history;
  TrainingWatch watch;
  StepWindow window;
  TrainingMeasure last;
  Clock::time_point started = Clock::now(), saved = Clock::now(), told = Clock::now(), looked = Clock::now();
  double seconds_before = 0;  // of earlier parts of the run
  long steps_before = 0;
  double waited_before = 0;  // for the teacher, as measurements were prepared [s]
  double told_every = 2;

  // Whether this process writes files, measures and says how the run goes on.
  bool leads() const { return !request.processes || request.processes->rank() == 0; }
  double seconds() const { return seconds_before + seconds_since(started); }
  void say(const std::string& line) const {
    if (request.log && leads()) *request.log << line << std::endl;
  }
};

// A path for a file that is copied elsewhere: a relative path, or the last folder and the name of an absolute one.
std::string travelling(const std::filesystem::path& path) {
  return (path.is_absolute() ? path.parent_path().filename() / path.filename() : path).string();
}

void write_weights(const TrainingRun& run, const std::string& name) {
  const Trainer& trainer = *run.trainer;
  WeightFile file;
  file.architecture = trainer.architecture;
  file.weights = trainer.network.weights;
  TrainingOptions options = run.options;
  options.weights = travelling(options.weights);
  options.samples.people = travelling(options.samples.people);
  file.training = training_yaml(options);
  file.trained_on = trained_on_json(trainer.trained_on);
  file.version = program_version();
  file.origin = {{"trained by", "selvedge train " + travelling(run.request.config)},
                 {"seed", std::to_string(run.options.seed)},
                 {"steps", fmt::format("{} of {}", trainer.counts.step, run.options.steps)},
                 {"hours", fmt::format("{:.3f}", run.seconds() / 3600)}};
  if (run.request.processes) file.origin.push_back({"processes", std::to_string(process_count(trainer))});
  write_weight_file(run.folder / name, file);
}

void write_tables(const TrainingRun& run) {
  write_file(run.folder / "steps.csv", run.history.steps);
  write_file(run.folder / "measures.csv", run.history.measures);
  write_file(run.folder / "training.html", training_page(run.options, run.history.steps, run.history.measures));
}

void save(TrainingRun& run) {
  run.history.seconds = run.seconds();
  if (run.leads()) {
    run.trainer->queue->locked([&] { write_soft_tissue(run.trainer->maker->world); });
    write_weights(run, "weights.h5");
    write_tables(run);
  }
  write_training_checkpoint(run.folder / "checkpoint.h5", *run.trainer, run.history);
  run.saved = Clock::now();
}

std::string measure_text(const TrainingMeasure& m) {
  const RollMeasure& r = m.roll;
  if (!r.finite) return fmt::format("step {}: the measuring roll-out is not finite after {} frames", m.step, r.frames);
  return fmt::format(
      "step {}: gap closed {:.3f} (skinned), {:.3f} (minimised); roll-out of {} frames: objective {:.4g} J, strain "
      "{:.2f} % "
      "(99 %: {:.1f} %), {:.2f} % of the vertices deep in the body, {:.0f} pairs at the end",
      m.step, m.skinned.closed, m.minimised.closed, r.frames, r.energy, 100 * r.strain, 100 * r.strain_99, 100 * r.deep,
      static_cast<double>(r.pairs_at_end));
}

// What the best weights are chosen by: the least distance from the solver with a teacher [mm], else the least energy of
// the measuring roll-out [J].
double score_of(const TrainingRun& run) { return run.trainer->teacher ? run.last.taught : run.last.roll.energy; }

// Statistics of the tangled starts; empty if none are counted.
std::string starts_text(std::vector<int> pairs) {
  if (pairs.empty()) return "";
  std::ranges::sort(pairs);
  const auto many = std::ranges::count_if(pairs, [](int n) { return n >= 20; });
  const auto at = [&](double part) {
    return pairs[static_cast<std::size_t>(part * static_cast<double>(pairs.size() - 1))];
  };
  return fmt::format("{} tangled starts: pairs 10 % {}, median {}, 90 % {}, most {}; {:.0f} % have 20 or more",
                     pairs.size(), at(0.1), at(0.5), at(0.9), pairs.back(),
                     100.0 * static_cast<double>(many) / static_cast<double>(pairs.size()));
}

void take_measure(TrainingRun& run) {
  if (!run.leads()) return;
  run.last = measure(*run.trainer, run.watch);
  run.history.measures += measure_line(run.last, run.seconds());
  run.say(measure_text(run.last));
  if (run.trainer->teacher)
    run.say(fmt::format("step {}: {:.2f} mm from the solver after {} frames with what runs behind the network",
                        run.last.step, run.last.taught, run.options.watch.taught_frames));
  if (const std::string starts = starts_text(run.trainer->start_pairs); !starts.empty()) run.say(starts);
  const double score = score_of(run);
  const bool counts = run.trainer->teacher ? std::isfinite(score) : run.last.roll.finite;
  if (counts && (run.history.best_step == 0 || score < run.history.best_score) && run.last.step > 0) {
    run.history.best_score = score;
    run.history.best_step = run.last.step;
    write_weights(run, "best.h5");
  }
  write_tables(run);
}

// What the teacher does for the run, as the end of a line; empty without a teacher.
std::string teacher_text(const TrainingRun& run) {
  if (!run.trainer->teacher) return "";
  const TeacherTally tally = run.trainer->teacher->tally();
  const TrainingCounts& counts = run.trainer->counts;
  std::string text =
      fmt::format(", {:.3g} targets/s by the solver, waited for it in {:.0f} % of the time", tally.rate(),
                  100 * (tally.waited - run.waited_before) / std::max(seconds_since(run.started), 1e-9));
  if (run.options.teacher.uses > 1)
    text += fmt::format(", {:.3g} samples a target",
                        1 + static_cast<double>(counts.again) / static_cast<double>(std::max(counts.frames, 1L)));
  return text;
}

void tell(TrainingRun& run, bool now = false) {
  if (!now && seconds_since(run.told) < run.told_every) return;
  run.told = Clock::now();
  run.told_every = std::min(1.5 * run.told_every, 60.0);
  const TrainingCounts& counts = run.counts;
  const double rate = static_cast<double>(counts.step - run.steps_before) / seconds_since(run.started);
  run.say(fmt::format("step {} of {}, {:.3g} samples/s, {} left, mean loss {:.4g}{}, {} bad samples, {} lost roll-outs",
                      counts.step, run.options.steps, rate * run.options.optimiser.batch * process_count(*run.trainer),
                      rate > 0 ? duration_text((run.options.steps - counts.step) / rate) : "?", run.window.mean_sum(),
                      teacher_work(run.options.objective).targets ? " (targets in mm)" : " J", counts.bad,
                      counts.lost) +
          teacher_text(run));
}

// Whether something that is done `times` times in the run is due after this step.
bool is_due(const TrainingRun& run, long step, int times) {
  const long every = std::max(1L, static_cast<long>(run.options.steps) / times);
  return step % every == 0 || step == run.options.steps;
}

// Whether this step is the first at or after the fraction of the run at which weights are kept.
bool is_kept_now(const TrainingRun& run) {
  const double at = run.options.watch.keep_at * run.options.steps;
  const auto step = static_cast<double>(run.trainer->counts.step);
  return at > 0 && step >= at && step - 1 < at;
}

// What is to be done after a step.
struct Wishes {
  bool save = false, stop = false;
};

Wishes wishes_of(TrainingRun& run) {
  Wishes wishes;
  wishes.stop = run.request.stop && run.request.stop();
  if (!run.leads()) return wishes;
  wishes.save = seconds_since(run.saved) > 60 * run.options.watch.checkpoint_minutes;
  if (wishes.stop || seconds_since(run.looked) < 1) return wishes;
  run.looked = Clock::now();
  wishes.stop = std::filesystem::exists(pause_file(run.folder));
  return wishes;
}

// Adds the step to the window, and to the counts of the run. Several processes do so with the steps and counts of all,
// and each gets the wishes of any.
Wishes take_in(TrainingRun& run, const StepRecord& record) {
  Wishes wishes = wishes_of(run);
  run.counts = run.trainer->counts;
  if (!run.request.processes) {
    run.window.add(record);
    return wishes;
  }
  StepWindow own;
  own.add(record);
  const std::vector<double> sums = own.sums();
  TrainingCounts& c = run.counts;
  std::vector<double> all{double(wishes.save), double(wishes.stop), double(c.frames),      double(c.lost),
                          double(c.given_up),  double(c.bad),       double(c.bad_in_a_row)};
  const std::size_t before = all.size();
  all.insert(all.end(), sums.begin(), sums.end());
  add_up(*run.request.processes, std::span(all));
  wishes = {all[0] > 0, all[1] > 0};
  long* counts[] = {&c.frames, &c.lost, &c.given_up, &c.bad, &c.bad_in_a_row};
  for (std::size_t k = 0; k < std::size(counts); ++k) *counts[k] = static_cast<long>(all[2 + k]);
  run.window.add(std::span(all).subspan(before), record.adam.learning_rate);
  return wishes;
}

// A line of steps.csv. Now and then processes see whether they still have the same weights.
void add_line(TrainingRun& run) {
  run.history.steps += run.window.take_line(*run.trainer, run.counts, run.seconds());
  if (run.request.processes)
    check_same_weights(*run.request.processes, run.trainer->architecture, run.trainer->network.weights,
                       fmt::format("training {}, step {}", run.options.name, run.counts.step));
}

// Returns false if it was stopped before the last step.
bool run_steps(TrainingRun& run) {
  Trainer& trainer = *run.trainer;
  while (trainer.counts.step < run.options.steps) {
    const StepRecord record = train_step(trainer);
    const Wishes wishes = take_in(run, record);
    if (record.adam.taken) {
      if (is_kept_now(run) && run.leads()) write_weights(run, "kept.h5");
      if (is_due(run, trainer.counts.step, lines_of_a_run)) add_line(run);
      if (is_due(run, trainer.counts.step, run.options.watch.measurements)) take_measure(run);
    }
    tell(run);
    if (wishes.save) save(run);
    if (wishes.stop) return false;
  }
  return true;
}

void begin(TrainingRun& run) {
  make_folder(run.folder);
  if (run.leads()) {
    run.lock.emplace(run.folder);
    remove_file(pause_file(run.folder));
  }
  if (run.request.resume) {
    run.trainer =
        read_training_checkpoint(run.folder / "checkpoint.h5", run.options, run.history, run.request.processes);
    run.history.steps = with_columns_of_now(run.history.steps);
  } else {
    run.trainer = make_trainer(run.options, run.request.processes);
    run.history.steps = steps_header();
    run.history.measures = measures_header();
  }
  run.seconds_before = run.history.seconds;
  run.counts = run.trainer->counts;
  run.steps_before = run.counts.step;
  if (!run.leads()) return;
  write_file(run.folder / "config.yaml", training_yaml(with_absolute_paths(run.options)));
  run.say(fmt::format("network `{}`: {} parameters, {} passes a frame", run.trainer->architecture.name,
                      parameter_count(run.trainer->architecture), run.trainer->architecture.passes));
  if (const int count = process_count(*run.trainer); count > 1)
    run.say(fmt::format("{} processes, {} samples a step", count, count * run.options.optimiser.batch));
  const TrainingWorld& world = run.trainer->maker->world;
  for (const std::string& warning : world.warnings) run.say("warning: " + warning);
  if (std::string who = people_text(world, run.options.samples); !who.empty()) {
    who.pop_back();  // the last line's end
    run.say(who);
  }
  run.watch = make_training_watch(run.options, *run.trainer);
  if (run.trainer->teacher) run.waited_before = run.trainer->teacher->tally().waited;
  run.started = run.saved = run.told = Clock::now();
}

// The training of this process.
TrainSummary train_alone(const TrainRequest& request) {
  TrainingRun run(request);
  run.options = read_training(request.config, request.overrides);
  run.folder = request.out.empty() ? std::filesystem::path("out") / "training" / run.options.name : request.out;
  for (const std::string& complaint : unfinished_ramps(run.options)) run.say("warning: " + complaint);
  begin(run);
  if (run.trainer->counts.step == 0) take_measure(run);
  const bool finished = run_steps(run);
  tell(run, true);
  save(run);
  if (run.leads()) remove_file(pause_file(run.folder));
  if (request.processes) wait_for_all(*request.processes);
  return {run.folder,
          finished,
          run.counts,
          run.history.seconds,
          run.history.best_step,
          run.history.best_score,
          run.trainer->teacher ? "mm" : "J",
          run.last};
}

}  // namespace

TrainSummary train(const TrainRequest& request) {
  restore_standard_arithmetic();
  return together(request.processes, [&] { return train_alone(request); });
}

std::filesystem::path pause_file(const std::filesystem::path& folder) { return folder / "pause"; }

bool pause_training(const std::filesystem::path& folder, double seconds) {
  if (!std::filesystem::exists(folder)) return false;
  write_file(pause_file(folder), "stop at a checkpoint\n");
  const Clock::time_point asked = Clock::now();
  while (std::filesystem::exists(pause_file(folder))) {
    if (seconds_since(asked) > seconds) {
      remove_file(pause_file(folder));
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return true;
}

std::string train_text(const TrainSummary& s) {
  return fmt::format("{:<20}{}\n{:<20}{} steps, {} frames, {} bad samples, {} lost roll-outs\n{:<20}{}\n{:<20}{}\n",
                     s.finished ? "trained" : "stopped", s.folder.string(), "work", s.counts.step, s.counts.frames,
                     s.counts.bad, s.counts.lost, "time", duration_text(s.seconds), "best roll-out",
                     s.best_step > 0
                         ? fmt::format("{:.4g} {} at step {} (best.h5)", s.best_score, s.score_unit, s.best_step)
                         : "none");
}

std::string train_json(const TrainSummary& s) {
  const RollMeasure& r = s.last.roll;
  const Json json = {{"folder", s.folder.string()},
                     {"finished", s.finished},
                     {"steps", s.counts.step},
                     {"frames", s.counts.frames},
                     {"bad_samples", s.counts.bad},
                     {"lost_rolls", s.counts.lost},
                     {"seconds", s.seconds},
                     {"best_step", s.best_step},
                     {"best_score", s.best_score},
                     {"score_unit", s.score_unit},
                     {"worn_closed", s.last.skinned.closed},
                     {"minimised_closed", s.last.minimised.closed},
                     {"strain", r.strain},
                     {"strain_99", r.strain_99},
                     {"pairs_at_end", r.pairs_at_end}};
  return json_text(json);
}

}  // namespace selvedge

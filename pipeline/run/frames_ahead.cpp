#include "pipeline/run/frames_ahead.hpp"

#include <chrono>
#include <future>
#include <utility>

#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/parallel.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "physics/frame/make_frame.hpp"

namespace selvedge {

FramesAhead::FramesAhead(const Scene& scene, Stepper& stepper, const std::function<Drive(double)>& drive_at, double dt,
                         int frames, const State& state, const StopFlag& stop)
    : stepper_(stepper),
      drive_at_(drive_at),
      dt_(dt),
      frames_(frames),
      state_(state),
      stop_(stop),
      asked_(stop ? [this] { return asks_to_stop(); } : StopFlag()),
      audits_(scene),
      threads_(most_threads()) {}

bool FramesAhead::asks_to_stop() {
  if (stopped(stop_)) stopping_ = true;
  return stopping_;
}

std::optional<MadeFrame> FramesAhead::next() {
  std::optional<MadeFrame> judged;
  const StopScope scope(asked_);  // also ends drives and audits on this thread
  try {
    for (bool goes_on = true; goes_on && !judged;) {
      Stopwatch watch;
      goes_on = advance(judged);
      if (threads_ > 1) arrangement_.took(watch.lap());
    }
  } catch (const Stopped&) {
    judged.emplace();
    judged->report.by = stepper_.traits().name;
    reject(Reason::stopped, judged->report);
  }
  return judged;
}

// Takes a step, or judges the waiting frame, or both. False if all steps are taken.
bool FramesAhead::advance(std::optional<MadeFrame>& judged) {
  // A rejected step has no state to judge.
  if (waiting_ && waiting_->report.status != StepStatus::accepted) {
    judged = std::exchange(waiting_, std::nullopt);
    return true;
  }
  const bool beside = threads_ > 1 && arrangement_.beside();
  const State& from = waiting_ ? waiting_->state : state_;
  const bool last = from.frame >= frames_;
  // No step is to be taken beside the audits of the waiting frame.
  if (waiting_ && (last || !beside || trouble_)) {
    judge(*waiting_);
    judged = std::exchange(waiting_, std::nullopt);
    return true;
  }
  if (last) return false;
  if (!beside) {
    judged = make_alone();
    return true;
  }
  MadeFrame made = step_beside(from);
  judged = std::exchange(waiting_, std::nullopt);
  if (judged && !judged->state.clean) {
    // The step began from a frame that is not clean. It is discarded, and its drive is needed again.
    coming_ = std::move(made.drive);
    trouble_ = nullptr;
  } else if (judged || state_.clean) {
    waiting_ = std::move(made);
    waiting_->state.clean = true;  // assumed until its audit
  } else {
    // Nothing is assumed after a state that is not clean.
    judge(made);
    judged = std::move(made);
  }
  return true;
}

void FramesAhead::judge(MadeFrame& made) {
  Stopwatch watch;
  made.state.clean = judge_frame(audits_, state_, made.drive, made.state, made.report);
  made.seconds += watch.lap();
}

// The drive that was made ahead, or else makes it now.
Drive FramesAhead::coming_drive(double time) {
  if (trouble_) std::rethrow_exception(std::exchange(trouble_, nullptr));
  if (!coming_) return drive_at_(time);
  return *std::exchange(coming_, std::nullopt);
}

MadeFrame FramesAhead::take_step(const State& from, Drive drive, double waited, const StopFlag& stop) {
  Stopwatch watch;
  MadeFrame made;
  made.drive = std::move(drive);
  made.report = stepper_.step(from, made.drive, dt_, made.state, {.stop = stop});
  made.report.seconds.body += waited;
  made.seconds = waited + watch.lap();
  return made;
}

MadeFrame FramesAhead::make_alone() {
  Stopwatch watch;
  MadeFrame made;
  made.drive = coming_drive(state_.time + dt_);
  const double waited = watch.lap();
  made.report = make_frame(stepper_, audits_, state_, made.drive, dt_, made.state, {.stop = asked_});
  made.report.seconds.body += waited;
  made.seconds = waited + watch.lap();
  return made;
}

// Judges the waiting frame, and makes the drive of the frame after the one being stepped. The step beside starts from
// the state that is judged, so that this must not change the state.
FramesAhead::Beside FramesAhead::work_beside(std::optional<double> time_after) {
  Beside done;
  if (waiting_) done.clean = judge_frame(audits_, state_, waiting_->drive, waiting_->state, waiting_->report);
  try {
    if (time_after) done.drive = drive_at_(*time_after);
  } catch (...) {
    done.trouble = std::current_exception();
  }
  return done;
}

// Takes a step with one thread less, while that thread audits and makes the drive. The phase `audit` of the waiting
// frame is then the time spent waiting for its audits.
MadeFrame FramesAhead::step_beside(const State& from) {
  Stopwatch watch;
  Drive drive = coming_drive(from.time + dt_);
  const double waited = watch.lap(), audited = waiting_ ? waiting_->report.seconds.audit : 0;
  restore_standard_arithmetic();  // on all threads, as the step begins with fewer
  std::atomic<bool> ended = false;
  std::future<Beside> beside = std::async(std::launch::async, [&, last = from.frame + 1 >= frames_] {
    restore_standard_arithmetic();
    use_threads(1);
    const StopFlag told = [this] { return stopping_.load(); };
    const StopScope scope(told);
    Beside done = work_beside(last ? std::nullopt : std::optional(from.time + dt_ + dt_));
    ended = true;
    return done;
  });
  MadeFrame made;
  {
    const ThreadLimit limit(threads_ - 1);
    made = take_step(from, std::move(drive), waited, [&] {  // asked often: once the rest is done, uses all threads
      if (ended) use_threads(threads_);
      return asks_to_stop();
    });
  }
  watch.lap();
  while (stop_ && beside.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) asks_to_stop();
  Beside done = beside.get();
  coming_ = std::move(done.drive);
  trouble_ = done.trouble;
  if (waiting_) {
    const double wait = watch.lap();
    waiting_->state.clean = done.clean;
    waiting_->report.seconds.audit = audited + wait;
    waiting_->seconds += wait;
  }
  return made;
}

}  // namespace selvedge

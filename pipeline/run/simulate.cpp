#include "pipeline/run/simulate.hpp"

#include <atomic>
#include <exception>
#include <future>
#include <optional>
#include <utility>

#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/parallel.hpp"
#include "collision/geometry/stop_scope.hpp"
#include "physics/steppers/step_audit.hpp"
#include "pipeline/run/arrangement.hpp"

namespace selvedge {
namespace {

struct MadeFrame {
  State state;
  Drive drive;
  StepReport report;
  LaterAudits later;  // empty: the verdict is known
  double seconds = 0;
};

// What the thread beside a step has found.
struct FoundBeside {
  StepReport report;  // of the frame before, with its audits
  bool clean = false;
  std::optional<Drive> drive;  // of the frame after
  std::exception_ptr trouble;  // why there is none
};

class FrameLoop {
 public:
  FrameLoop(Stepper& stepper, const std::function<Drive(double)>& drive_at, double dt, int frames, State& state,
            const FrameSink& sink, const StopFlag& stop)
      : stepper_(stepper), drive_at_(drive_at), dt_(dt), frames_(frames), state_(state), sink_(sink), stop_(stop) {}

  StepReport run() {
    const StopScope scope(asked_);  // drives and audits that this thread makes end, too
    try {
      for (bool goes_on = true; goes_on;) {
        const Clock::time_point started = Clock::now();
        goes_on = next_frame();
        if (threads_ > 1) arrangement_.took(seconds_since(started));
      }
    } catch (const Stopped&) {
      last_ = {};
      last_.by = stepper_.traits().name;
      last_.status = StepStatus::rejected;
      last_.reason = Reason::stopped;
    }
    return std::move(last_);
  }

 private:
  bool next_frame();
  bool asks_to_stop() {
    if (stopped(stop_)) stopping_ = true;
    return stopping_;
  }
  MadeFrame make(const State& from, Drive drive, bool leave_audits, const StopFlag& stop);
  MadeFrame make_again(Drive drive, double seconds);
  FoundBeside look_beside(std::optional<double> time_after);
  FoundBeside make_and_look(const State& from, std::optional<MadeFrame>& made);
  MadeFrame make_alone();
  bool end_waiting(FoundBeside& found, std::optional<MadeFrame>& after);
  Drive coming_drive(double time);
  bool hand_over(MadeFrame& made);

  Stepper& stepper_;
  const std::function<Drive(double)>& drive_at_;
  double dt_;
  int frames_;
  State& state_;  // the last one that the sink has seen
  const FrameSink& sink_;
  const StopFlag& stop_;
  std::atomic<bool> stopping_ = false;  // what it said last, for the thread beside
  StopFlag asked_ = stop_ ? [this] { return asks_to_stop(); } : StopFlag();
  int threads_ = most_threads();
  Arrangement arrangement_;
  std::optional<MadeFrame> waiting_;  // the frame after it, for its verdict
  std::optional<Drive> coming_;       // of the next frame to make
  std::exception_ptr trouble_;        // why it is not known
  StepReport last_;
};

// The drive that was made ahead, or one made now.
Drive FrameLoop::coming_drive(double time) {
  if (trouble_) std::rethrow_exception(std::exchange(trouble_, nullptr));
  if (!coming_) return drive_at_(time);
  return *std::exchange(coming_, std::nullopt);
}

MadeFrame FrameLoop::make(const State& from, Drive drive, bool leave_audits, const StopFlag& stop) {
  const Clock::time_point started = Clock::now();
  MadeFrame made;
  made.drive = std::move(drive);
  made.report =
      stepper_.step(from, made.drive, dt_, made.state, {.stop = stop, .later = leave_audits ? &made.later : nullptr});
  made.seconds = seconds_since(started);
  return made;
}

// A frame once more, after what was in vain.
MadeFrame FrameLoop::make_again(Drive drive, double seconds) {
  MadeFrame made = make(state_, std::move(drive), false, asked_);
  made.seconds += seconds;
  return made;
}

// The verdict on the frame that waits, and the drive of the frame after the one that is being made.
FoundBeside FrameLoop::look_beside(std::optional<double> time_after) {
  FoundBeside found;
  if (waiting_) {
    found.report = waiting_->report;
    found.clean = confirm(waiting_->later, found.report);
  }
  try {
    if (time_after) found.drive = drive_at_(*time_after);
  } catch (...) {
    found.trouble = std::current_exception();
  }
  return found;
}

// Makes a frame, and on another thread looks for the rest.
FoundBeside FrameLoop::make_and_look(const State& from, std::optional<MadeFrame>& made) {
  const Clock::time_point started = Clock::now();
  Drive drive = coming_drive(from.time + dt_);
  const double waited = seconds_since(started);
  restore_standard_arithmetic();  // on all threads: the step begins with fewer
  std::atomic<bool> done = false;
  std::future<FoundBeside> beside = std::async(std::launch::async, [&, last = from.frame + 1 >= frames_] {
    restore_standard_arithmetic();
    use_threads(1);
    const StopFlag told = [this] { return stopping_.load(); };
    const StopScope scope(told);
    FoundBeside found = look_beside(last ? std::nullopt : std::optional(from.time + dt_ + dt_));
    done = true;
    return found;
  });
  {
    const ThreadLimit limit(threads_ - 1);
    made = make(from, std::move(drive), from.clean, [&] {  // asked again and again: what is left is for all threads
      if (done) use_threads(threads_);
      return asks_to_stop();
    });
  }
  made->seconds += waited;
  const Clock::time_point made_at = Clock::now();
  while (stop_ && beside.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) asks_to_stop();
  FoundBeside found = beside.get();
  if (waiting_) waiting_->seconds += found.report.seconds.audit = seconds_since(made_at);
  return found;
}

MadeFrame FrameLoop::make_alone() {
  const Clock::time_point started = Clock::now();
  Drive drive = coming_drive(state_.time + dt_);
  const double waited = seconds_since(started);
  MadeFrame made = make(state_, std::move(drive), false, asked_);
  made.seconds += waited;
  return made;
}

// To the sink, with its verdict; false ends the run.
bool FrameLoop::hand_over(MadeFrame& made) {
  last_ = std::move(made.report);
  if (last_.reason == Reason::stopped) return false;
  const bool accepted = last_.status == StepStatus::accepted;
  if (accepted) std::swap(state_, made.state);
  const StopFlag nobody;
  const StopScope whole(nobody);  // what the sink begins with a frame, it ends
  return sink_({state_, made.drive, last_, made.seconds}) && accepted;
}

// Hands over the frame that waited, or makes it again if it is not clean, and then what was made after it is void.
bool FrameLoop::end_waiting(FoundBeside& found, std::optional<MadeFrame>& after) {
  MadeFrame before = *std::exchange(waiting_, std::nullopt);
  if (found.clean) {
    before.report = std::move(found.report);
    return hand_over(before);
  }
  before = make_again(std::move(before.drive), before.seconds + (after ? after->seconds : 0));
  if (after) {  // the drive after that one is asked for again
    coming_ = std::move(after->drive);
    trouble_ = nullptr;
  }
  after.reset();
  return hand_over(before);
}

// Makes a frame and hands over what has its verdict; false: the run is over.
bool FrameLoop::next_frame() {
  const bool beside = threads_ > 1 && arrangement_.beside();
  const State& from = waiting_ ? waiting_->state : state_;
  std::optional<MadeFrame> made;
  if (waiting_ && (from.frame >= frames_ || !beside || trouble_)) {
    FoundBeside found = look_beside({});
    return end_waiting(found, made);
  }
  if (from.frame >= frames_) return false;
  if (!beside) {
    made = make_alone();
    return hand_over(*made);
  }
  FoundBeside found = make_and_look(from, made);
  coming_ = std::move(found.drive);
  trouble_ = found.trouble;
  if (waiting_ && !end_waiting(found, made)) return false;
  if (!made) return true;
  const bool accepted = made->report.status == StepStatus::accepted, left = !made->later.audits.empty();
  if (accepted && left) {
    waiting_ = std::move(made);
    return true;
  }
  // A rejected step says what its audits found until then.
  if (left && made->report.reason != Reason::stopped) made = make_again(std::move(made->drive), made->seconds);
  return hand_over(*made);
}

}  // namespace

StepReport simulate(Stepper& stepper, const std::function<Drive(double)>& drive_at, double dt, int frames, State& state,
                    const FrameSink& sink, const StopFlag& stop) {
  return FrameLoop(stepper, drive_at, dt, frames, state, sink, stop).run();
}

}  // namespace selvedge

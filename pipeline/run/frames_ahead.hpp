#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <optional>

#include "physics/frame/frame_audits.hpp"
#include "pipeline/run/arrangement.hpp"

namespace selvedge {

struct MadeFrame {
  State state;  // not to be used if the step was rejected
  Drive drive;
  StepReport report;
  double seconds = 0;  // wall-clock time of its step, and of waiting for its drive and its audits
};

// Makes the frames of a run one after the other, as make_frame does. Where there are two threads or more, and where it
// is faster (arrangement.hpp), one of them audits the last frame and makes the drive of the next one beside a step.
// That step assumes that the last frame is clean. If it is not, the step is discarded and taken again. No frame is
// returned before its verdict. Frames have the same bits on any number of threads.
class FramesAhead {
 public:
  // Makes frames up to number `frames`. `state`: the start of the run; the caller must update it to the last frame that
  // `next` returned. `drive_at` is called by one thread at a time, and only while `next` runs.
  FramesAhead(const Scene&, Stepper&, const std::function<Drive(double time)>& drive_at, double dt, int frames,
              const State& state, const StopFlag& stop);
  // The next frame; absent if all frames are made. A frame that `stop` ended is rejected as `stopped`. Throws what
  // `drive_at` throws.
  std::optional<MadeFrame> next();

 private:
  // Results of the thread beside a step.
  struct Beside {
    bool clean = false;          // verdict of the waiting frame
    std::optional<Drive> drive;  // of the frame after the one being stepped
    std::exception_ptr trouble;  // what `drive_at` threw; null: nothing
  };
  bool asks_to_stop();
  bool advance(std::optional<MadeFrame>& judged);
  void judge(MadeFrame&);
  MadeFrame take_step(const State& from, Drive, double waited, const StopFlag&);
  MadeFrame make_alone();
  MadeFrame step_beside(const State& from);
  Beside work_beside(std::optional<double> time_after);
  Drive coming_drive(double time);

  Stepper& stepper_;
  const std::function<Drive(double)>& drive_at_;
  double dt_;
  int frames_;
  const State& state_;
  const StopFlag& stop_;
  std::atomic<bool> stopping_ = false;  // whether `stop_` was true; the thread beside reads it
  StopFlag asked_;
  FrameAudits audits_;
  int threads_;
  Arrangement arrangement_;
  std::optional<MadeFrame> waiting_;  // the frame after `state_`, which has no verdict yet
  std::optional<Drive> coming_;       // of the next frame to make
  std::exception_ptr trouble_;        // what `drive_at` threw when it was asked for that drive
};

}  // namespace selvedge

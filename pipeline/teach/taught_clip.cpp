#include "pipeline/teach/taught_clip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "collision/geometry/error.hpp"
#include "physics/energies/measures.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/scene/make_stepper.hpp"

namespace selvedge {
namespace {

// The state with the memory that a carried guess of any terms reads.
State remembering(const State& before, const Drive& drive, State state) {
  replace_blocks("carried", carried_memory(before, drive, state.x, 2), state.memory);
  return state;
}

void add_motion(const Setup& setup, const State& from, const Drive& drive, const Points& to, CarriedFit& fit) {
  const double dt = 1 / setup.run.fps;
  add_frame(setup.scene, carried_terms(setup.scene, from, drive, dt, all_carried_terms), to - from.x, fit);
}

double mean_root(double sum, int count) { return count > 0 ? std::sqrt(sum / count) : 0; }

}  // namespace

double RollDistances::distance_after_one() const { return mean_root(one, ones); }
double RollDistances::distance_after_ten() const { return mean_root(ten, tens); }

std::optional<TaughtClip> simulate_clip(Setup setup, const std::string& name, const TeachStop& stop, CarriedFit* fit) {
  const std::optional<Start> start = prepare(setup, stop);
  if (!start) return {};
  TaughtClip clip{name, std::move(setup), {}, {start->state.x}};
  const std::unique_ptr<Stepper> solver = make_stepper(clip.setup);
  State state = start->state, known = state;
  bool stopped = false;
  const StepReport last = simulate(
      clip.setup.scene, *solver, clip.setup.drive_at, 1 / clip.setup.run.fps, clip.setup.run.frames, state,
      [&](const FrameEvent& event) {
        if (event.report.status != StepStatus::accepted) return false;
        if (fit) add_motion(clip.setup, known, event.drive, event.state.x, *fit);
        known = remembering(known, event.drive, event.state);
        clip.run.push_back(known.x);
        const bool whole = known.frame + roll_frames <= clip.setup.run.frames;
        if (known.frame % roll_frames == 0 && whole) clip.begins.push_back(known);
        stopped = stop && stop();
        return !stopped;
      },
      stop);
  if (stopped || last.reason == Reason::stopped) return {};
  if (last.status != StepStatus::accepted)
    throw Error(fmt::format("the solver rejects the frame after {} of the clip `{}`", state.frame, name),
                clip.setup.file.string(), "leave the clip out, or run fewer frames of it (--set run.frames)");
  return clip;
}

bool roll_out(const TaughtClip& clip, Stepper& stepper, const TeachStop& stop, RollDistances& measure,
              CarriedFit* fit) {
  const Setup& setup = clip.setup;
  const double dt = 1 / setup.run.fps;
  const std::unique_ptr<Stepper> solver = fit ? make_stepper(setup) : nullptr;
  for (const State& begin : clip.begins) {
    State state = begin, known = begin, taught;
    bool stopped = false;
    const int end = begin.frame + roll_frames;
    const StepReport last = simulate(
        setup.scene, stepper, setup.drive_at, dt, end, state,
        [&](const FrameEvent& event) {
          ++measure.frames;
          if (event.report.status != StepStatus::accepted) return false;
          const double distance = root_mean_square(event.state.x - clip.run[static_cast<std::size_t>(state.frame)]);
          if (state.frame == begin.frame + 1) measure.one += distance * distance, ++measure.ones;
          if (state.frame == end) measure.ten += distance * distance, ++measure.tens;
          measure.pairs = std::max(measure.pairs, event.report.collision.pairs_after);
          measure.passed += event.report.collision.passed_through;
          if (solver && solver->step(known, event.drive, dt, taught).status == StepStatus::accepted)
            add_motion(setup, known, event.drive, taught.x, *fit);
          if (solver) known = remembering(known, event.drive, event.state);
          stopped = stop && stop();
          return !stopped;
        },
        stop);
    if (stopped || last.reason == Reason::stopped) return false;
    if (last.status == StepStatus::rejected) ++measure.refused;
  }
  return true;
}

}  // namespace selvedge

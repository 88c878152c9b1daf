#include "pipeline/run/prepare.hpp"

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/garments/garment_rest.hpp"
#include "pipeline/run/resume.hpp"
#include "pipeline/run/run_folder.hpp"
#include "pipeline/run/run_inputs_yaml.hpp"
#include "pipeline/run/simulate.hpp"

namespace selvedge {
namespace {

// Keeps the state of a draped start from time to time; keeps nothing where no folder is given.
class DrapingKeeper {
 public:
  DrapingKeeper(const Setup& setup, const std::optional<KeptDraping>& kept) : kept_(kept) {
    if (kept_) inputs_ = run_inputs(setup);
  }
  // The state from which to begin.
  State begin(const Setup& setup) {
    if (kept_ && kept_->goes_on) return read_draping(draping_file(kept_->folder), setup, inputs_);
    if (kept_) remove_results(kept_->folder);
    keep(setup.initial);
    return setup.initial;
  }
  void keep(const State& state) {
    if (kept_) write_checkpoint(draping_file(kept_->folder), state, inputs_);
    last_ = Clock::now();
  }
  void keep_if_due(const State& state) {
    if (kept_ && state.frame < 0 && seconds_since(last_) > kept_->seconds) keep(state);
  }

 private:
  std::optional<KeptDraping> kept_;
  RunInputs inputs_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace

std::filesystem::path draping_file(const std::filesystem::path& folder) { return folder / "draping.h5"; }

std::optional<Start> prepare(const Setup& setup, const std::function<bool()>& stop, Progress* progress,
                             const StopFlag& interrupt, const std::optional<KeptDraping>& kept) {
  const int frames = -setup.initial.frame;
  if (frames <= 0) return Start{setup.initial, setup.prepared};
  DrapingKeeper keeper(setup, kept);
  Start start{keeper.begin(setup), setup.prepared};
  const int before = frames + start.state.frame;  // made by a process that was stopped
  const Clock::time_point started = Clock::now();
  const std::unique_ptr<Stepper> stepper =
      make_following_stepper(setup.scene, setup.followers, make_recovering_conventional_stepper(setup.scene));
  State& state = start.state;
  bool ended = false;
  if (progress) progress->begin(before, frames, "draping, frame");
  const FrameSink sink = [&](const FrameEvent& event) {
    if (progress) progress->frame(event.state.frame + frames);
    keeper.keep_if_due(event.state);
    ended = stop && stop();
    return !ended;
  };
  const StepReport last = simulate(setup.scene, *stepper, setup.drive_at, 1 / setup.run.fps, 0, state, sink, interrupt);
  if (progress) progress->end();
  if (ended || last.reason == Reason::stopped) {
    if (state.frame < 0) keeper.keep(state);
    return {};
  }
  if (last.status != StepStatus::accepted)
    throw Error(fmt::format("cannot be draped: a step is rejected {} before time 0", counted(-state.frame, "frame")),
                setup.file.string(), "let the body come more slowly (start.seconds), or start from: skinned");
  const Audit audit = last.audit.value_or(Audit{});
  const double moving = moving_share(state.v, 1);
  const std::string done = before > 0 ? fmt::format(" ({} of them before it was stopped)", before) : "";
  start.prepared =
      fmt::format("draped in {}{}, {}; {}, {} inside, fastest vertex {:.2g} m/s, {}", counted(frames, "frame"), done,
                  duration_text(seconds_since(started)), counted(audit.intersecting_pairs(), "pair"),
                  counted(audit.inside_vertices, "vertex", "vertices"), state.v.rowwise().norm().maxCoeff(),
                  moving < resting_share ? std::string("at rest")
                                         : fmt::format("not at rest: {:.0f} % of the vertices are faster "
                                                       "than {:g} mm/s",
                                                       100 * moving, 1000 * resting_speed));
  state.time = 0;
  state.v = setup.velocity;
  state.memory.clear();
  return start;
}

}  // namespace selvedge

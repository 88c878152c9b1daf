#include "pipeline/compare/compare_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "collision/audit/audit.hpp"
#include "collision/exact/penetration_depth.hpp"
#include "collision/search/intersections.hpp"
#include "learned/steppers/learned_state.hpp"
#include "physics/frame/frame_audits.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/measures/run_measures.hpp"
#include "pipeline/reports/report_fields.hpp"
#include "pipeline/run/record_frame.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/run/summary.hpp"
#include "pipeline/scene/make_stepper.hpp"

namespace selvedge {
namespace {

// The sink of a timed run.
struct RunWatch {
  const Setup& setup;
  CompareRun& run;
  EnergyTerms terms;
  std::optional<RunMeasures> measures;
  std::optional<TrajectoryWriter> writer;
  std::map<std::string, std::vector<double>> phases;
  std::vector<long> verdicts = std::vector<long>(verdict_names().size(), 0);  // frames
  Points acceleration;                                                        // of the frame to come
  std::vector<IntersectionCache> obstacles;

  RunWatch(const Setup& s, const State& start, CompareRun& r, const TimedRunOptions& options,
           const StepperTraits& stepper)
      : setup(s), run(r), terms(energy_terms(s.scene, stepper)) {
    const Drive drive = setup.drive_at(start.time);
    if (options.measured) begin_measures(options, start, drive);
    if (options.trajectory.empty()) return;
    TrajectoryInfo info = trajectory_info(setup.scene, setup.config, stepper.name, setup.run.fps);
    info.looks = setup.looks;
    writer.emplace(options.trajectory, info);
    writer->append(record_initial(setup.scene, terms, start, drive));
  }

  void begin_measures(const TimedRunOptions& options, const State& start, const Drive& drive) {
    measures.emplace(setup.scene, setup.run.frames, options.judged_frames);
    measures->begin(start.x, joined_rows(start.obstacles), pairs_of_cloth(setup.scene.surface, start.x));
    acceleration = graph_state(setup.scene, start, drive).acceleration;
  }

  bool obstacle_crosses_itself(const Drive& drive) {
    obstacles.resize(setup.scene.obstacles.size());
    for (std::size_t k = 0; k < obstacles.size(); ++k)
      if (!intersecting_pairs(setup.scene.obstacles[k].surface, drive.obstacles[k], obstacles[k]).empty()) return true;
    return false;
  }

  void note_phases(const PhaseTimes& s) {
    for (const BoundField<PhaseTimes>& phase : phase_fields())
      phases[phase.name].push_back(1000 * number_of(phase.get(s), {}));
  }

  void operator()(const FrameEvent& event) {
    run.seconds.push_back(event.seconds);
    const StepReport& report = event.report;
    run.substeps += report.substeps;
    run.newton += report.iterations;
    run.linear += report.linear_iterations;
    run.pairs = std::max(run.pairs, report.collision.pairs_after);
    run.passed_through += report.collision.passed_through;
    if (report.verdict != Verdict::none) ++verdicts[static_cast<std::size_t>(report.verdict)];
    note_phases(report.seconds);
    if (writer) writer->append(record_frame(setup.scene, terms, event));
    if (!measures || report.status != StepStatus::accepted) return;
    const State& state = event.state;
    MeasuredFrame frame{state.x, joined_rows(state.obstacles), std::move(acceleration)};
    if (report.audit) {
      frame.pairs = pairs_of_cloth(setup.scene, report, state.x);
      run.pairs = std::max(run.pairs, frame.pairs);
      frame.body_pairs = static_cast<int>(report.audit->obstacle_pairs.size());
      frame.meets_body = !report.audit->obstacle_pairs.empty() || report.audit->inside_vertices > 0;
    }
    const bool may_be_inside = !report.audit || report.audit->inside_vertices > 0 || state.pinched;
    for (std::size_t k = 0; may_be_inside && k < setup.scene.obstacles.size(); ++k)
      frame.depth =
          std::max(frame.depth, penetration_depth(setup.scene.obstacles[k].surface, event.drive.obstacles[k], state.x));
    frame.crossed = frame.depth > 0 && obstacle_crosses_itself(event.drive);
    frame.pushed_out = report.collision.pushed_out;
    frame.kinetic = energies(setup.scene, terms, state.x, state.v, event.drive.acceleration).kinetic;
    measures->add(std::move(frame));
    acceleration = graph_state(setup.scene, state, event.drive).acceleration;
  }
};

// Of a hybrid stepper: the part of its frames that a proposal has become, and the part with each verdict.
void note_verdicts(const std::vector<long>& frames, CompareRun& run) {
  const auto all = static_cast<double>(std::accumulate(frames.begin(), frames.end(), 0L));
  if (all == 0) return;
  const auto part = [&](Verdict verdict) {
    return static_cast<double>(frames[static_cast<std::size_t>(verdict)]) / all;
  };
  run.measures["proposal_share"] = part(Verdict::admitted) + part(Verdict::refined);
  for (std::size_t k = 0; k < frames.size(); ++k)
    if (frames[k] > 0) run.measures["verdict_" + verdict_names()[k]] = static_cast<double>(frames[k]) / all;
}

}  // namespace

std::optional<CompareRun> timed_run(const Setup& setup, const Start& start, const TimedRunOptions& options,
                                    const Stop& stop) {
  CompareRun run;
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  State state = start.state;
  bool stopped = false;
  RunWatch watch(setup, start.state, run, options, stepper->traits());
  RowWatch row(options.limits, setup.scene);
  const StepReport last = simulate(
      setup.scene, *stepper, setup.drive_at, 1 / setup.run.fps, setup.run.frames, state,
      [&](const FrameEvent& event) {
        watch(event);
        stopped = stop && stop();
        return !stopped && row.goes_on(event.report, event.state.x);
      },
      row.stop_flag());
  if (stopped) return {};
  if (watch.writer) watch.writer->close();
  run.trouble = row.trouble(state.frame, setup.run.frames);
  if (run.trouble.empty() && last.status != StepStatus::accepted)
    run.trouble = fmt::format("rejects a step after frame {} ({})", state.frame,
                              reason_names().at(static_cast<std::size_t>(last.reason)));
  const auto energy = [&](const State& at) {
    return energies(setup.scene, watch.terms, at.x, at.v, setup.drive_at(at.time).acceleration).total();
  };
  run.lost = energy(start.state) - energy(state);
  run.end = hash_of(bytes_of(state.x));
  if (watch.measures) {
    run.measures = watch.measures->values();
    run.pairs_by_frame = watch.measures->pairs_by_frame();
  }
  note_verdicts(watch.verdicts, run);
  run.measures["finished"] = run.trouble.empty() ? 1 : 0;
  for (const auto& [phase, times] : watch.phases)
    if (const double middle = median(times); middle > 0) run.phases[phase] = middle;
  return run;
}

std::string trouble_of_bare_run(const std::filesystem::path& trajectory) {
  const TrajectoryReader reader(trajectory);
  for (int i = 1; i < reader.frame_count(); ++i) {
    const StepReport& report = reader.frame(i).report;
    if (report.status != StepStatus::accepted) continue;
    const CollisionReport& collision = report.collision;
    if (report.by != "learned" || report.fell_back) return fmt::format("frame {} was made by `{}`", i, report.by);
    if (report.iterations > 0) return fmt::format("frame {} was solved", i);
    if (collision.impulses + collision.zones + collision.shortened > 0)
      return fmt::format("frame {} was responded to", i);
    const bool settles = i == 1;  // HOOD's first frame, which the measure `pushed_out` counts
    if (collision.pushed_out > 0 && !settles) return fmt::format("frame {} was pushed out of the body", i);
  }
  return {};
}

}  // namespace selvedge

#include "pipeline/run/run_scene.hpp"

#include <algorithm>
#include <optional>

#include "collision/geometry/stop_scope.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/hdf5/xdmf.hpp"
#include "pipeline/host/folder_lock.hpp"
#include "pipeline/host/peak_memory.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/run/record_frame.hpp"
#include "pipeline/run/resume.hpp"
#include "pipeline/run/run_folder.hpp"
#include "pipeline/run/run_inputs_yaml.hpp"
#include "pipeline/scene/make_stepper.hpp"

namespace selvedge {
namespace {

RunSummary empty_summary(const Setup& setup, const std::string& prepared, const Stepper& stepper) {
  RunSummary summary;
  summary.program_version = program_version();
  summary.scene = setup.file.string();
  summary.stepper = stepper.traits().name;
  summary.prepared = prepared;
  summary.vertices = setup.scene.surface.vertex_count;
  summary.triangles = static_cast<int>(setup.scene.surface.triangles.rows());
  summary.frames_wanted = setup.run.frames;
  summary.self_audited = setup.scene.contact.self;
  for (const Obstacle& obstacle : setup.scene.obstacles) summary.switched_off.push_back({obstacle.name});
  for (const PlanLine& line : plan_lines(setup.scene))
    if (!line.in) summary.left_out.push_back(line);
  for (const PlanLine& line : ignored_lines(setup.scene, stepper.traits())) summary.left_out.push_back(line);
  summary.warnings = run_warnings(setup, stepper.traits());
  return summary;
}

// The sink of a run: trajectory, summary, checkpoints.
struct Recorder {
  const Setup& setup;
  const RunRequest& request;
  RunSummary& summary;
  const RunInputs& inputs;
  TrajectoryWriter writer;
  EnergyTerms terms;
  std::vector<WornCloth> worn = setup.worn;
  OutcomeWatch outcome{setup.scene, setup.outcomes, setup.run.frames / setup.run.fps};
  int next = 0;
  Clock::time_point last_checkpoint = Clock::now();

  void add(const Frame& frame) {
    writer.append(frame);
    for (WornCloth& one : worn) {
      const Cloth& cloth = setup.scene.cloths[static_cast<std::size_t>(one.cloth)];
      one.watch.see(next, frame.x.middleRows(cloth.first_vertex, cloth.vertex_count).cast<double>(),
                    frame.obstacles[static_cast<std::size_t>(one.obstacle)].cast<double>());
    }
    add_frame(summary, next++, frame);
  }

  void checkpoint(const State& state) {
    write_checkpoint(request.out / "checkpoint.h5", state, inputs);
    last_checkpoint = Clock::now();
  }

  bool operator()(const FrameEvent& event) {
    add(record_frame(setup.scene, terms, event));
    outcome(event.state, event.drive);
    if (request.observe) request.observe(event);
    if (request.progress) request.progress->frame(event.state.frame);
    const bool stop = request.stop && request.stop();
    if (stop || seconds_since(last_checkpoint) > request.checkpoint_seconds) checkpoint(event.state);
    return !stop;
  }
};

// The state of a kept frame, as far as outcomes are measured in it. A vertex of an obstacle that is where it was
// wanted, but for the rounding of the file, is there.
State seen_state(const Frame& frame, int index, const Drive& drive) {
  State state;
  state.time = frame.time;
  state.frame = index;
  state.x = frame.x.cast<double>();
  for (std::size_t k = 0; k < frame.obstacles.size(); ++k) {
    const PointsF& kept = frame.obstacles[k];
    const Points& wanted = drive.obstacles[k];
    Points& x = state.obstacles.emplace_back(kept.cast<double>());
    for (Eigen::Index i = 0; i < std::min(kept.rows(), wanted.rows()); ++i)
      if (wanted.row(i).cast<float>() == kept.row(i)) x.row(i) = wanted.row(i);
  }
  return state;
}

// Copies frames up to the checkpoint's from the file of the interrupted run, and judges them as if they were just made.
void copy_frames(const ResumedRun& resumed, const std::filesystem::path& folder, Recorder& recorder) {
  try {
    for (int i = 0; i <= resumed.state.frame; ++i) {
      check_stop();
      const Frame frame = resumed_frame(resumed, i, folder);
      recorder.add(frame);
      if (recorder.setup.outcomes.empty()) continue;
      const Drive drive = recorder.setup.drive_at(frame.time);
      recorder.outcome(i < resumed.state.frame ? seen_state(frame, i, drive) : resumed.state, drive);
    }
  } catch (...) {
    std::filesystem::remove(folder / "resumed.h5");
    throw;
  }
}

// Completes the summary of a run whose last step ended at `frame`.
void finish(Recorder& recorder, const StepReport& last, int frame) {
  RunSummary& summary = recorder.summary;
  for (WornCloth& one : recorder.worn)
    if (one.watch.left_in >= 0) summary.slid_off.push_back(std::move(one.watch));
  summary.outcomes = recorder.outcome.results();
  const auto& asked = recorder.setup.outcomes;
  for (std::size_t k = 0; k < asked.size(); ++k)
    summary.outcome_lines.push_back(outcome_text(asked[k], summary.outcomes[k]));
  const bool rejected = last.status == StepStatus::rejected && last.reason != Reason::stopped;
  summary.end = rejected ? RunEnd::rejected : frame < summary.frames_wanted ? RunEnd::interrupted : RunEnd::finished;
  if (rejected) summary.reason = reason_names().at(static_cast<std::size_t>(last.reason));
  summary.peak_memory = peak_memory();
}

// The configuration for the run's folder: its paths are relative to the scene's folder.
std::string config_in(const std::filesystem::path& out, const Setup& setup) {
  if (setup.file.empty() || setup.config.starts_with("folder: ") ||
      setup.config.find("\nfolder: ") != std::string::npos)
    return setup.config;
  const std::filesystem::path from = std::filesystem::absolute(setup.file).parent_path();
  std::error_code problem;
  std::filesystem::path folder = std::filesystem::relative(from, out, problem);
  if (problem || folder.empty()) folder = from;
  return "folder: " + quoted_yaml(folder.string()) + "\n" + setup.config;
}

// From the start; null: from the folder's checkpoint.
RunSummary run_from(const Start* start, const Setup& setup, Stepper& stepper, const RunRequest& request) {
  const StopScope scope(request.interrupt);
  make_folder(request.out);
  std::optional<FolderLock> lock;
  if (!request.locked) lock.emplace(request.out);
  const std::filesystem::path file = request.out / "run.h5", saved = request.out / "checkpoint.h5";
  ResumedRun resumed;
  if (!start) resumed = read_resumed(request.out, setup, stepper.traits(), run_inputs(setup));
  State state = start ? start->state : resumed.state;
  if (start)
    remove_results(request.out);
  else
    remove_made_of_frames(request.out);
  const RunInputs inputs = start ? run_inputs(setup) : resumed.inputs;
  write_file(request.out / "config.yaml", config_in(request.out, setup));

  // A resumed run writes to another file until all kept frames of the old one are copied.
  const std::filesystem::path first_file = start ? file : request.out / "resumed.h5";
  RunSummary summary = empty_summary(setup, start ? start->prepared : setup.prepared, stepper);
  summary.inputs_hash = hash_of_inputs(inputs);
  TrajectoryInfo info = trajectory_info(setup.scene, setup.config, stepper.traits().name, setup.run.fps);
  info.looks = setup.looks;
  info.contact_forces = stepper.traits().reports_contact_forces;
  Recorder recorder{setup,
                    request,
                    summary,
                    inputs,
                    TrajectoryWriter(first_file, std::move(info)),
                    energy_terms(setup.scene, stepper.traits())};
  if (start) {
    const Drive drive = setup.drive_at(state.time);
    recorder.add(record_initial(setup.scene, recorder.terms, state, drive));
    recorder.outcome(state, drive);
    recorder.checkpoint(state);  // so that a run that is killed soon is resumed, too
    remove_file(draping_file(request.out));
  } else {
    copy_frames(resumed, request.out, recorder);
    rename_file(first_file, file);
  }

  if (request.progress) request.progress->begin(state.frame, setup.run.frames);
  const StepReport last = simulate(setup.scene, stepper, setup.drive_at, 1 / setup.run.fps, setup.run.frames, state,
                                   std::ref(recorder), request.interrupt);
  if (last.reason == Reason::stopped) recorder.checkpoint(state);
  if (request.progress) request.progress->end();

  recorder.writer.close();
  finish(recorder, last, state.frame);
  if (summary.end == RunEnd::finished) remove_file(saved);
  write_xdmf(file);
  write_file(request.out / "summary.json", summary_json(summary));
  return summary;
}

}  // namespace

RunSummary run_scene(const Setup& setup, const Start& start, Stepper& stepper, const RunRequest& request) {
  return run_from(&start, setup, stepper, request);
}

RunSummary resume_scene(const Setup& setup, Stepper& stepper, const RunRequest& request) {
  return run_from(nullptr, setup, stepper, request);
}

}  // namespace selvedge

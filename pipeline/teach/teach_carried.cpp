#include "pipeline/teach/teach_carried.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "physics/steppers/carried_stepper.hpp"
#include "pipeline/cells/scene_cells.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/run/progress.hpp"
#include "pipeline/scene/make_stepper.hpp"

namespace selvedge {
namespace {

// A vertex's own set counts from about this number of frames on.
constexpr double own_weight = 30;

void say(const TeachRequest& request, const std::string& line) {
  if (request.log) *request.log << line << "\n" << std::flush;
}

void check_clips(const TeachRequest& request) {
  if (request.clips.empty()) throw Error("there is no clip to fit on", "--clips", "name some, such as walk,dance_sway");
  for (const std::string& clip : request.held_out)
    if (std::ranges::find(request.clips, clip) != request.clips.end())
      throw Error("the clip `" + clip + "` is fitted on, and held out", "--held-out", "name it in one of the two");
}

// The key of the body's clip.
std::string clip_key(const TeachRequest& request) {
  const Setup setup = read_setup(request.scene, request.overrides);
  const auto body = [](const auto& one) { return one != nullptr; };
  if (std::ranges::count_if(setup.bodies, body) != 1)
    throw Error("has not exactly one body, whose clips could be taught", request.scene.string(),
                "give the scene one obstacle with `body`");
  const auto at = std::ranges::find_if(setup.bodies, body) - setup.bodies.begin();
  return fmt::format("obstacles.{}.body.clip", at);
}

Setup read_with(const TeachRequest& request, const std::string& key, const std::string& clip,
                const std::string& stepper) {
  std::vector<std::string> overrides = request.overrides;
  overrides.insert(overrides.end(), {key + "=" + quoted_yaml(clip), "run.stepper=" + stepper,
                                     "run.learned.weights=" + quoted_yaml(std::filesystem::absolute(request.out))});
  Setup setup = read_setup(request.scene, overrides);
  if (setup.run.frames < 2 * roll_frames)
    throw Error(fmt::format("has {} frames of the clip `{}`", setup.run.frames, clip), request.scene.string(),
                fmt::format("run {} or more (--set run.frames)", 2 * roll_frames));
  read_tissue(cache_folder(), setup.bodies);
  return setup;
}

// The solver's run of each clip. Fewer: stopped.
std::vector<TaughtClip> simulate_clips(const TeachRequest& request, const std::string& key,
                                       const std::vector<std::string>& names, CarriedFit* fit) {
  std::vector<TaughtClip> clips;
  for (const std::string& name : names) {
    const Clock::time_point started = Clock::now();
    std::optional<TaughtClip> clip =
        simulate_clip(read_with(request, key, name, "conventional"), name, request.stop, fit);
    if (!clip) break;
    keep_tissue(clip->setup, request.log);
    say(request, fmt::format("{}: {} by the solver, {}", name, counted(clip->setup.run.frames, "frame"),
                             duration_text(seconds_since(started))));
    clips.push_back(std::move(*clip));
  }
  return clips;
}

CarriedModel fitted(const TeachRequest& request, const CarriedFit& fit) {
  return request.own ? fitted_own_sets(fit, own_weight) : CarriedModel{fitted_scene_set(fit)};
}

// Rolls the model out on the clips; the last round adds nothing to the fit. False: stopped.
bool roll_round(const TeachRequest& request, const std::vector<TaughtClip>& clips, const CarriedModel& model, bool last,
                TeachRound& round, CarriedFit& fit) {
  for (const TaughtClip& clip : clips) {
    const std::unique_ptr<Stepper> stepper = make_following_stepper(
        clip.setup.scene, clip.setup.followers, make_carried_stepper(clip.setup.scene, model, carried_fitted_name));
    if (!roll_out(clip, *stepper, request.stop, round.rolls, last ? nullptr : &fit)) return false;
  }
  return true;
}

// False: stopped.
bool fit_in_rounds(const TeachRequest& request, const std::vector<TaughtClip>& clips, CarriedFit& fit,
                   TeachReport& report) {
  double nearest = 0;
  for (int r = 0; r <= request.rounds; ++r) {
    TeachRound round;
    const CarriedModel model = fitted(request, fit);
    for (const CarriedFit::OfVertex& one : fit.vertices) round.frames = std::max(round.frames, one.frames);
    round.before = distance_left(fit, {});
    round.after = distance_left(fit, model);
    const Clock::time_point started = Clock::now();
    if (!roll_round(request, clips, model, r == request.rounds, round, fit)) return false;
    const double distance = round.rolls.distance_after_ten();
    say(request, fmt::format("round {} of {}: {:.2f} mm after ten frames, {}", r, request.rounds, 1e3 * distance,
                             duration_text(seconds_since(started))));
    if (r == 0 || distance < nearest) {
      nearest = distance;
      report.chosen = r;
      report.taught.model = model;
    }
    report.rounds.push_back(round);
  }
  return true;
}

// False: stopped.
bool measure_held_out(const TeachRequest& request, const std::string& key, TeachReport& report) {
  const std::vector<TaughtClip> clips = simulate_clips(request, key, request.held_out, nullptr);
  if (clips.size() < request.held_out.size()) return false;
  if (clips.empty()) return true;
  for (const char* stepper : {"carried", carried_fitted_name, "carried_rough"}) {
    TeachRow row{stepper, {}};
    for (const TaughtClip& clip : clips) {
      const Setup setup = read_with(request, key, clip.name, stepper);
      if (!roll_out(clip, *make_stepper(setup), request.stop, row.rolls, nullptr)) return false;
    }
    report.rows.push_back(row);
  }
  return true;
}

}  // namespace

TeachReport teach_carried(const TeachRequest& request) {
  h5::check_out_name(request.out, "coefficients");
  check_clips(request);
  const std::string key = clip_key(request);
  for (const std::vector<std::string>* names : {&request.clips, &request.held_out})
    for (const std::string& name : *names)
      read_with(request, key, name, "conventional");  // what is wrong is said first
  TeachReport report;
  CarriedFit fit;
  const std::vector<TaughtClip> clips = simulate_clips(request, key, request.clips, &fit);
  report.finished = clips.size() == request.clips.size() && fit_in_rounds(request, clips, fit, report);
  if (!report.finished) return report;
  const Surface& surface = clips.front().setup.scene.surface;
  report.taught.clips = request.clips;
  report.taught.mesh = mesh_hash(surface);
  report.taught.vertices = surface.vertex_count;
  write_taught_carried(request.out, report.taught);
  report.finished = measure_held_out(request, key, report);
  return report;
}

}  // namespace selvedge

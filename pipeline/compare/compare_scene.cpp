#include "pipeline/compare/compare_scene.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "pipeline/cells/scene_cells.hpp"
#include "pipeline/compare/compare_run.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/machine_name.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/run/progress.hpp"
#include "pipeline/run/summary.hpp"
#include "pipeline/scene/make_stepper.hpp"

namespace selvedge {
namespace {

// Why a setting is left out before it is read; empty: it is not.
std::string missing_part(const CompareSetting& setting, const Kinds& kinds) {
  if (!setting.stepper.empty() && !kinds.find(setting.stepper))
    return "left out: this program has no stepper `" + setting.stepper + "`";
  if (setting.weights.empty() || std::filesystem::exists(setting.weights)) return {};
  return "left out: there is no weight file " + setting.weights.string();
}

// Why a setting is left out after it is read; empty: it is not.
std::string unfit(const CompareSetting& setting, const Setup& setup, const Setup& reference) {
  if (setup.run.fps != reference.run.fps)
    return fmt::format("left out: it makes {:g} frames a second, and the scene {:g}", setup.run.fps, reference.run.fps);
  if (!setting.weights.empty() && !reads_weights(setup))
    return "left out: `weights` has no part in the stepper `" + setup.kind.name + "`; give `stepper`";
  return {};
}

// An error's cure stands on a line of its own.
std::string on_one_line(const std::string& error) {
  const std::size_t end = error.find("\n  cure: ");
  return end == std::string::npos ? error : error.substr(0, end) + "; " + error.substr(end + 3);
}

// `whose`: the reference's or a setting's overrides, which an error names with the comparison file.
Setup read_as(const Comparison& comparison, const std::string& whose, const CompareScene& scene, bool short_form,
              const std::vector<std::string>& overrides) {
  return read_for(comparison.file.string() + ": " + whose + " on scene `" + scene.name + "`",
                  [&] { return read_compared(scene, short_form, overrides, comparison.kinds); });
}

std::filesystem::path floor_file(const SceneWork& work) { return work.folder / "floor.json"; }
std::filesystem::path errors_file(const SceneWork& work, std::size_t setting) {
  return work.folder / fmt::format("errors_{}.json", setting);
}
std::filesystem::path run_file(const SceneWork& work, std::size_t setting, int repeat) {
  return work.folder / fmt::format("run_{}_{}.json", setting, repeat);
}
std::string errors_key(const SceneWork& work, std::size_t setting) {
  return work.keys.reference + " " + work.keys.settings[setting];
}
// Times are of a machine.
std::string run_key(const SceneWork& work, std::size_t setting) {
  return work.keys.settings[setting] + " " + work.machine;
}

void say(const CellWatch& watch, const std::string& line) {
  if (watch.log) *watch.log << line << "\n" << std::flush;
}

// Size and length of a scene without references. Always true: nothing stops it.
bool describe_scene(SceneWork& work) {
  work.floor.scene = work.scene->name;
  for (const std::optional<Setup>& setup : work.setups)
    if (setup) {
      work.floor.vertices = setup->scene.surface.vertex_count;
      work.floor.frames = setup->run.frames;
    }
  return true;
}

// The floor and every setting's errors. The reference is made only if one of them is not there. False: stopped.
bool find_errors(const Comparison& comparison, bool short_form, const CellWatch& watch, SceneWork& work) {
  work.errors.assign(work.setups.size(), {});
  if (work.scene->states == 0) return describe_scene(work);
  std::optional<CompareReference> reference;
  const auto need_reference = [&] {
    if (reference) return true;
    const auto started = Clock::now();
    reference = read_for(comparison.file.string() + ": scene `" + work.scene->name + "`",
                         [&] { return make_reference(comparison, *work.scene, short_form, watch.stop); });
    if (!reference) return false;
    work.floor = reference->floor;
    write_file(floor_file(work), part_json(work.floor, work.keys.reference));
    say(watch, fmt::format("{}: reference, {}; floor {:.2g} m", work.scene->name, duration_text(seconds_since(started)),
                           work.floor.floor()));
    return true;
  };
  const auto floor = read_floor(whole_file(floor_file(work)), work.keys.reference);
  if (floor)
    work.floor = *floor;
  else if (!need_reference())
    return false;
  for (std::size_t s = 0; s < work.setups.size(); ++s) {
    const std::filesystem::path file = errors_file(work, s);
    const std::string key = errors_key(work, s);
    std::optional<CompareErrors> errors =
        work.setups[s] ? read_errors(whole_file(file), key) : CompareErrors{work.trouble[s]};
    if (!errors) {
      if (!need_reference()) return false;
      errors = errors_of(*work.setups[s], *reference, comparison.limits, watch.stop);
      if (!errors) return false;
      write_file(file, part_json(*errors, key));
      say(watch, fmt::format("{}: errors of {}: {:.2g} m from the reference{}{}", work.scene->name,
                             comparison.settings[s].name, errors->temporal, errors->trouble.empty() ? "" : ", ",
                             errors->trouble));
    }
    work.errors[s] = *errors;
  }
  return true;
}

// All settings start alike: a scene is prepared once. False: stopped.
bool prepare_settings(const CellWatch& watch, SceneWork& work) {
  for (const std::optional<Setup>& setup : work.setups) {
    if (!setup) continue;
    const std::optional<Start> start = prepare(*setup, watch.stop);
    if (start) work.start = *start;
    return start.has_value();
  }
  return true;
}

// Every row of an evaluation that a network makes is the bare network, by its stored run.
void check_bare(const Setup& setup, const std::filesystem::path& trajectory) {
  if (setup.kind.network != NetworkUse::alone) return;
  if (const std::string trouble = trouble_of_bare_run(trajectory); !trouble.empty())
    throw Error("a row of the evaluation is not the bare network: " + trouble, trajectory.string(),
                "name gated rows by a stepper of their own");
}

// Every setting once, in turn. False: stopped.
bool time_settings(const Comparison& comparison, int repeat, const CellWatch& watch, SceneWork& work) {
  for (std::size_t s = 0; s < work.setups.size(); ++s) {
    if (!work.setups[s]) continue;
    const std::filesystem::path file = run_file(work, s, repeat);
    std::optional<CompareRun> run = read_run(whole_file(file), run_key(work, s));
    const std::filesystem::path trajectory = trajectory_of(work, s);
    if (work.keeps && repeat == 0 && !std::filesystem::exists(trajectory)) run.reset();
    const bool kept = run.has_value();
    if (!run) {
      TimedRunOptions options;
      options.judged_frames = comparison.judged_frames;
      options.limits = comparison.limits;
      const bool judged = !comparison.evaluation.baseline.empty();
      if (repeat == 0 && (work.keeps || judged)) options.trajectory = trajectory;
      run = timed_run(*work.setups[s], work.start, options, watch.stop);
      if (!run) return false;
      if (judged && repeat == 0) check_bare(*work.setups[s], trajectory);
      if (!work.keeps) std::filesystem::remove(trajectory);
      write_file(file, part_json(*run, run_key(work, s)));
    }
    say(watch, fmt::format("{} {} of {}: {}, {:.1f} ms a frame{}{}", work.scene->name, repeat + 1, comparison.repeats,
                           comparison.settings[s].name, 1000 * median(run->seconds), kept ? " (kept from before)" : "",
                           run->trouble.empty() ? "" : ", " + run->trouble));
    work.runs[s].push_back(std::move(*run));
  }
  return true;
}

}  // namespace

SceneWork open_scene(const Comparison& comparison, const CompareScene& scene, bool short_form,
                     const std::string& program) {
  SceneWork work;
  work.scene = &scene;
  const Setup reference = read_as(comparison, "the reference", scene, short_form, comparison.reference);
  work.keys.program = program;
  work.keys.reference = fmt::format("{} {} {} {} {} {}", program, inputs_key(reference), scene.states, scene.horizon,
                                    comparison.jitter, joined(comparison.algebraic));
  for (const CompareSetting& setting : comparison.settings) {
    std::string trouble = missing_part(setting, comparison.kinds);
    if (!trouble.empty()) {
      work.trouble.push_back(trouble);
      work.setups.emplace_back();
      work.keys.settings.emplace_back();
      continue;
    }
    Setup setup = read_as(comparison, "setting `" + setting.name + "`", scene, short_form, setting.overrides);
    work.keys.settings.push_back(fmt::format("{} {} {} {} {}", program, inputs_key(setup), comparison.judged_frames,
                                             comparison.limits.pairs, comparison.limits.seconds));
    try {
      make_stepper(setup);
    } catch (const Error& error) {
      trouble = on_one_line(error.what());
    }
    if (trouble.empty()) trouble = unfit(setting, setup, reference);
    work.trouble.push_back(trouble);
    work.setups.push_back(trouble.empty() ? std::optional<Setup>(std::move(setup)) : std::nullopt);
  }
  return work;
}

std::vector<std::filesystem::path> needs_of(const Comparison& comparison, const SceneWork& work) {
  std::vector<std::filesystem::path> needs{comparison.file};
  for (const std::optional<Setup>& setup : work.setups) {
    if (!setup) continue;
    for (const std::filesystem::path& file : needs_of(*setup))
      if (std::ranges::find(needs, file) == needs.end()) needs.push_back(file);
  }
  return needs;
}

std::string key_of(const Comparison& comparison, const SceneWork& work) {
  std::string all = fmt::format("{} {} {}", work.keys.reference, comparison.repeats, work.keeps);
  for (std::size_t s = 0; s < work.setups.size(); ++s)
    all += "\n" + comparison.settings[s].name + ": " + work.keys.settings[s] + (work.setups[s] ? "" : " left out");
  return fmt::format("{:016x}", hash_of(all));
}

bool measure_scene(const Comparison& comparison, bool short_form, const CellWatch& watch, SceneWork& work) {
  work.machine = machine_name();
  work.runs.assign(work.setups.size(), {});
  if (!find_errors(comparison, short_form, watch, work) || !prepare_settings(watch, work)) return false;
  for (int repeat = 0; repeat < comparison.repeats; ++repeat)
    if (!time_settings(comparison, repeat, watch, work)) return false;
  return true;
}

bool read_measured(const Comparison& comparison, const std::string& machine, SceneWork& work) {
  bool whole = true;
  work.machine = machine;
  work.runs.assign(work.setups.size(), {});
  work.errors.assign(work.setups.size(), {});
  if (work.scene->states == 0)
    describe_scene(work);
  else if (const auto floor = read_floor(whole_file(floor_file(work)), work.keys.reference))
    work.floor = *floor;
  else
    whole = false;
  for (std::size_t s = 0; s < work.setups.size(); ++s) {
    if (!work.setups[s]) continue;
    if (const auto errors = read_errors(whole_file(errors_file(work, s)), errors_key(work, s)))
      work.errors[s] = *errors;
    else
      whole = whole && work.scene->states == 0;
    for (int repeat = 0; repeat < comparison.repeats; ++repeat)
      if (auto run = read_run(whole_file(run_file(work, s, repeat)), run_key(work, s)))
        work.runs[s].push_back(std::move(*run));
    whole = whole && std::ssize(work.runs[s]) == comparison.repeats;
  }
  return whole;
}

std::filesystem::path trajectory_of(const SceneWork& work, std::size_t setting) {
  return work.folder / fmt::format("row_{}.h5", setting);
}

}  // namespace selvedge

#include "pipeline/compare/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "collision/geometry/error.hpp"
#include "pipeline/compare/compare_parts.hpp"
#include "pipeline/compare/compare_run.hpp"
#include "pipeline/compare/compared_drapes.hpp"
#include "pipeline/compare/comparison.hpp"
#include "pipeline/compare/evaluation.hpp"
#include "pipeline/compare/sequences.hpp"
#include "pipeline/compare/training_sequences.hpp"
#include "pipeline/compare/volume_report.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/progress.hpp"
#include "pipeline/run/summary.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/view/view.hpp"

namespace selvedge {
namespace {

// All that a part's result depends on.
struct Keys {
  std::string program, reference;
  std::vector<std::string> settings;
};

struct SceneWork {
  const CompareScene* scene = nullptr;
  bool keeps = false;  // the trajectories of its rows
  std::filesystem::path folder;
  Keys keys;
  std::vector<std::optional<Setup>> setups;  // absent: this build cannot, and `trouble` says why
  std::vector<std::string> trouble;
  Start start;  // of all of them
  CompareFloor floor;
  std::vector<CompareErrors> errors;
  std::vector<std::vector<CompareRun>> runs;  // of each setting
};

// Why a setting is left out before it is read; empty: it is not.
std::string missing_part(const CompareSetting& setting, const Kinds& kinds) {
  if (!setting.stepper.empty() && !kinds.find(setting.stepper))
    return "left out: this program has no stepper `" + setting.stepper + "`";
  if (setting.weights.empty() || std::filesystem::exists(setting.weights)) return {};
  return "left out: there is no weight file " + setting.weights.string();
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

// Reads every setup and makes every stepper once, so that what is wrong is said before hours of work.
SceneWork open_scene(const CompareRequest& request, const Comparison& comparison, const CompareScene& scene,
                     const std::string& program) {
  SceneWork work;
  work.scene = &scene;
  work.folder = request.out / "parts" / scene.name;
  make_folder(work.folder);
  const Setup reference = read_as(comparison, "the reference", scene, request.short_form, comparison.reference);
  work.keys.program = program;
  work.keys.reference = fmt::format("{} {:016x} {} {} {} {}", program, hash_of(reference.config), scene.states,
                                    scene.horizon, comparison.jitter, joined(comparison.algebraic));
  for (const CompareSetting& setting : comparison.settings) {
    std::string trouble = missing_part(setting, comparison.kinds);
    if (!trouble.empty()) {
      work.trouble.push_back(trouble);
      work.setups.emplace_back();
      work.keys.settings.emplace_back();
      continue;
    }
    Setup setup = read_as(comparison, "setting `" + setting.name + "`", scene, request.short_form, setting.overrides);
    work.keys.settings.push_back(fmt::format(
        "{} {:016x} {:016x} {} {} {} {}", program, hash_of(setup.config), hash_of(whole_file(setting.weights)),
        Eigen::nbThreads(), comparison.judged_frames, comparison.limits.pairs, comparison.limits.seconds));
    try {
      make_stepper(setup);
    } catch (const Error& error) {
      trouble = on_one_line(error.what());
    }
    work.trouble.push_back(trouble);
    work.setups.push_back(trouble.empty() ? std::optional<Setup>(std::move(setup)) : std::nullopt);
  }
  work.runs.resize(comparison.settings.size());
  return work;
}

void say(const CompareRequest& request, const std::string& line) {
  if (request.log) *request.log << line << "\n" << std::flush;
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
bool find_errors(const CompareRequest& request, const Comparison& comparison, SceneWork& work) {
  work.errors.assign(work.setups.size(), {});
  if (work.scene->states == 0) return describe_scene(work);
  std::optional<CompareReference> reference;
  const auto need_reference = [&] {
    if (reference) return true;
    const auto started = Clock::now();
    reference = read_for(comparison.file.string() + ": scene `" + work.scene->name + "`",
                         [&] { return make_reference(comparison, *work.scene, request.short_form, request.stop); });
    if (!reference) return false;
    work.floor = reference->floor;
    write_file(work.folder / "floor.json", part_json(work.floor, work.keys.reference));
    say(request, fmt::format("{}: reference, {}; floor {:.2g} m", work.scene->name,
                             duration_text(seconds_since(started)), work.floor.floor()));
    return true;
  };
  const auto floor = read_floor(whole_file(work.folder / "floor.json"), work.keys.reference);
  if (floor)
    work.floor = *floor;
  else if (!need_reference())
    return false;
  for (std::size_t s = 0; s < work.setups.size(); ++s) {
    const std::filesystem::path file = work.folder / fmt::format("errors_{}.json", s);
    const std::string key = work.keys.reference + " " + work.keys.settings[s];
    std::optional<CompareErrors> errors =
        work.setups[s] ? read_errors(whole_file(file), key) : CompareErrors{work.trouble[s]};
    if (!errors) {
      if (!need_reference()) return false;
      errors = errors_of(*work.setups[s], *reference, comparison.limits, request.stop);
      if (!errors) return false;
      write_file(file, part_json(*errors, key));
      say(request, fmt::format("{}: errors of {}: {:.2g} m from the reference{}{}", work.scene->name,
                               comparison.settings[s].name, errors->temporal, errors->trouble.empty() ? "" : ", ",
                               errors->trouble));
    }
    work.errors[s] = *errors;
  }
  return true;
}

// All settings start alike: a scene is prepared once. False: stopped.
bool prepare_settings(const CompareRequest& request, SceneWork& work) {
  for (const std::optional<Setup>& setup : work.setups) {
    if (!setup) continue;
    const std::optional<Start> start = prepare(*setup, request.stop);
    if (start) work.start = *start;
    return start.has_value();
  }
  return true;
}

std::filesystem::path trajectory_of(const std::filesystem::path& folder, std::size_t setting) {
  return folder / fmt::format("row_{}.h5", setting);
}

// Every row of an evaluation that a network makes is the bare network, by its stored run.
void check_bare(const Setup& setup, const std::filesystem::path& trajectory) {
  if (setup.kind.network != NetworkUse::alone) return;
  if (const std::string trouble = trouble_of_bare_run(trajectory); !trouble.empty())
    throw Error("a row of the evaluation is not the bare network: " + trouble, trajectory.string(),
                "name gated rows by a stepper of their own");
}

// Every setting once, in turn. False: stopped.
bool time_settings(const CompareRequest& request, const Comparison& comparison, int repeat, SceneWork& work) {
  for (std::size_t s = 0; s < work.setups.size(); ++s) {
    if (!work.setups[s]) continue;
    const std::filesystem::path file = work.folder / fmt::format("run_{}_{}.json", s, repeat);
    std::optional<CompareRun> run = read_run(whole_file(file), work.keys.settings[s]);
    const std::filesystem::path trajectory = trajectory_of(work.folder, s);
    if (work.keeps && repeat == 0 && !std::filesystem::exists(trajectory)) run.reset();
    const bool kept = run.has_value();
    if (!run) {
      TimedRunOptions options;
      options.judged_frames = comparison.judged_frames;
      options.limits = comparison.limits;
      const bool judged = !comparison.evaluation.baseline.empty();
      if (repeat == 0 && (work.keeps || judged)) options.trajectory = trajectory;
      run = timed_run(*work.setups[s], work.start, options, request.stop);
      if (!run) return false;
      if (judged && repeat == 0) check_bare(*work.setups[s], trajectory);
      if (!work.keeps) std::filesystem::remove(trajectory);
      write_file(file, part_json(*run, work.keys.settings[s]));
    }
    say(request, fmt::format("{} {} of {}: {}, {:.1f} ms a frame{}{}", work.scene->name, repeat + 1, comparison.repeats,
                             comparison.settings[s].name, 1000 * median(run->seconds),
                             kept ? " (kept from before)" : "", run->trouble.empty() ? "" : ", " + run->trouble));
    work.runs[s].push_back(std::move(*run));
  }
  return true;
}

CompareRow row_of(const SceneWork& work, const std::string& setting, std::size_t s) {
  CompareRow row;
  row.scene = work.scene->name;
  row.setting = setting;
  row.outfit = work.scene->outfit;
  row.tangled = work.scene->tangled;
  row.trouble = work.trouble[s];
  if (work.scene->states > 0) row.floor = work.floor.floor();
  if (s < work.errors.size()) {
    const CompareErrors& errors = work.errors[s];
    if (row.trouble.empty()) row.trouble = errors.trouble;
    row.algebraic = errors.algebraic;
    row.algebraic_largest = errors.algebraic_largest;
    row.temporal = errors.temporal;
    row.measures = errors.measures;
  }
  if (work.runs[s].empty()) return row;
  const CompareRun& first = work.runs[s].front();
  std::vector<double> seconds, medians;
  for (const CompareRun& run : work.runs[s]) {
    seconds.insert(seconds.end(), run.seconds.begin(), run.seconds.end());
    medians.push_back(1000 * median(run.seconds));
    row.reproduced = row.reproduced && run.end == first.end;
  }
  const auto frames = static_cast<double>(first.seconds.size());
  if (!first.trouble.empty()) row.trouble = first.trouble;
  row.measures.insert(first.measures.begin(), first.measures.end());
  if (seconds.empty()) return row;
  row.ms = 1000 * median(seconds);
  row.ms_spread = *std::ranges::max_element(medians) - *std::ranges::min_element(medians);
  row.dt = frames / work.setups[s]->run.fps / static_cast<double>(first.substeps);
  if (work.floor.lost > 0) row.decay = first.lost / work.floor.lost;
  row.newton = static_cast<double>(first.newton) / frames;
  row.linear = static_cast<double>(first.linear) / frames;
  row.pairs = first.pairs;
  row.passed_through = first.passed_through;
  row.pairs_by_frame = first.pairs_by_frame;
  for (const auto& [phase, ms] : first.phases) row.measures["ms_" + phase] = ms;
  return row;
}

// No step was rejected, and no limit ended the run.
bool came_to_its_end(const CompareRow& row) {
  return !row.measures.contains("finished") || row.measure("finished") == 1;
}

// A hybrid row that hardly uses its proposals is another name for the parent of the hybrid.
bool stands_for_itself(const CompareRow& row) {
  constexpr double least_share = 0.3;
  return !row.measures.contains("proposal_share") || row.measure("proposal_share") >= least_share;
}

bool may_be_ranked(const CompareRow& row) {
  return std::isfinite(row.temporal) && std::isfinite(row.ms) && is_clean(row) && came_to_its_end(row) &&
         stands_for_itself(row);
}

// What may be said of a row's error: no less than the floor.
double known_error(const CompareRow& row) { return std::max(row.temporal, row.floor); }

void write_results(const CompareRequest& request, const Comparison& comparison, const std::vector<SceneWork>& all,
                   CompareResult& result) {
  result.floors.clear();
  result.rows.clear();
  for (const SceneWork& work : all) {
    if (work.floor.scene.empty()) continue;
    result.floors.push_back(work.floor);
    for (std::size_t s = 0; s < comparison.settings.size(); ++s)
      result.rows.push_back(row_of(work, comparison.settings[s].name, s));
  }
  rank(result.rows);
  write_file(request.out / "compare.json", compare_json(result));
  write_file(request.out / "compare.csv", compare_csv(result));
  write_file(request.out / "compare.txt", compare_table(result));
  if (!comparison.evaluation.baseline.empty()) {
    const Evaluation found = evaluated(comparison, result.floors, result.rows);
    result.evaluation = evaluation_text(found);
    write_file(request.out / "evaluation.txt", result.evaluation);
    write_file(request.out / "evaluation.json", evaluation_json(found));
  }
  write_file(request.out / "compare.html", compare_page(comparison, result));
}

}  // namespace

void rank(std::vector<CompareRow>& rows) {
  for (CompareRow& row : rows) {
    row.ranked = may_be_ranked(row) && row.temporal > row.floor;
    row.front = may_be_ranked(row) && std::ranges::none_of(rows, [&](const CompareRow& other) {
                  return other.scene == row.scene && may_be_ranked(other) && other.ms < row.ms &&
                         known_error(other) <= known_error(row) + row.floor;
                });
  }
}

// One page a scene that plays its rows side by side. It is an extra: nothing is lost where it cannot be made.
void write_views(const CompareRequest& request, const SceneWork& work, CompareResult& result) {
  if (!work.keeps) return;
  constexpr std::size_t most_rows = 4, most_bytes = 12'000'000;
  std::vector<std::filesystem::path> runs;
  for (std::size_t s = 0; s < work.setups.size() && runs.size() < most_rows; ++s)
    if (work.setups[s] && std::filesystem::exists(trajectory_of(work.folder, s)))
      runs.push_back(trajectory_of(work.folder, s));
  result.views = request.out / "views";
  make_folder(result.views);
  try {
    if (!runs.empty()) write_view(runs, result.views / (work.scene->name + ".html"), {.limit = most_bytes});
  } catch (const Error& error) {
    say(request, work.scene->name + ": no page that plays it: " + error.what());
  }
}

// The volume that rows leave, once all runs are there.
void add_volumes(const CompareRequest& request, const Comparison& comparison, const std::vector<SceneWork>& all,
                 CompareResult& result) {
  if (!comparison.evaluation.volume || !result.finished) return;
  std::vector<KeptRun> runs;
  for (const SceneWork& work : all)
    for (std::size_t s = 0; s < comparison.settings.size(); ++s) {
      const std::filesystem::path run = trajectory_of(work.folder, s);
      if (!work.setups[s] || !std::filesystem::exists(run)) continue;
      const double ms = row_of(work, comparison.settings[s].name, s).ms;
      runs.push_back({comparison.settings[s].name, work.scene->outfit, work.scene->name, run, 1000 / ms});
    }
  result.evaluation += write_volume_report(runs, comparison.evaluation.baseline, request.out);
}

// The tables of the repulsive layer, of the trainings that are there. False: stopped.
bool report_drapes(const CompareRequest& request, const Comparison& comparison, CompareResult& result) {
  if (comparison.drapes.empty()) return true;
  result.views = request.out / "views";
  std::vector<MeasuredDrapes> all;
  for (const ComparedDrapes& one : comparison.drapes) {
    std::optional<MeasuredDrapes> made = read_for(comparison.file.string() + ": drapes `" + one.name + "`", [&] {
      return measured_drapes(one, result.views, request.log, request.stop);
    });
    if (!made) return false;
    if (!made->rows.empty()) write_file(request.out / (one.name + ".csv"), drape_table_csv(made->rows));
    all.push_back(std::move(*made));
    result.repulsion = repulsion_tables(all);
    result.repulsion_figures = repulsion_figures(all);
    write_file(request.out / "repulsion.txt", result.repulsion);
  }
  return true;
}

// The scenes of `sequences`, if there are any.
void add_made_scenes(Comparison& comparison) {
  const std::string& training = comparison.sequences.training;
  if (training.empty() && comparison.sequences.count == 0) return;
  read_for(comparison.file.string() + ": sequences",
           [&] { training.empty() ? add_sequences(comparison) : add_training_sequences(comparison); });
}

CompareResult compare(const CompareRequest& request) {
  Comparison comparison = read_comparison(request.file, request.short_form, request.overrides);
  comparison.kinds = request.kinds;
  add_made_scenes(comparison);
  if (!comparison.split_text.empty()) say(request, comparison.split_text);
  const std::string program = program_key();
  make_folder(request.out);
  std::vector<SceneWork> all;
  for (const CompareScene& scene : comparison.scenes) all.push_back(open_scene(request, comparison, scene, program));
  for (std::size_t k = 0; k < all.size(); ++k) all[k].keeps = static_cast<int>(k) < comparison.keep_runs;
  CompareResult result;
  result.finished = report_drapes(request, comparison, result);
  for (SceneWork& work : all) {
    if (!result.finished) break;
    result.finished = find_errors(request, comparison, work) && prepare_settings(request, work);
    for (int repeat = 0; result.finished && repeat < comparison.repeats; ++repeat) {
      result.finished = time_settings(request, comparison, repeat, work);
      write_results(request, comparison, all, result);
    }
    if (!result.finished) break;
    write_views(request, work, result);
  }
  write_results(request, comparison, all, result);
  add_volumes(request, comparison, all, result);
  write_compare_hdf5(request.out / "compare.h5", result);
  result.plots = plot_comparison(result, request.out);
  return result;
}

}  // namespace selvedge

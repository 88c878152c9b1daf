#include "pipeline/compare/compare.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "collision/geometry/error.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/cells/scene_cells.hpp"
#include "pipeline/compare/compare_plots.hpp"
#include "pipeline/compare/compare_scene.hpp"
#include "pipeline/compare/compared_drapes.hpp"
#include "pipeline/compare/evaluation.hpp"
#include "pipeline/compare/sequences.hpp"
#include "pipeline/compare/training_sequences.hpp"
#include "pipeline/compare/volume_report.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/run/summary.hpp"
#include "pipeline/view/view.hpp"

namespace selvedge {
namespace {

void say(std::ostream* log, const std::string& line) {
  if (log) *log << line << "\n" << std::flush;
}

struct CompareWork {
  CompareRequest request;
  Comparison comparison;
  std::string program;
  TangledSearch search;
  std::vector<std::string> names;                // of the cells
  std::vector<std::optional<SceneWork>> scenes;  // read when they are needed
};

CompareRow row_of(const SceneWork& work, const std::string& setting, std::size_t s) {
  CompareRow row;
  row.scene = work.scene->name;
  row.setting = setting;
  row.machine = work.machine;
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

namespace {

void write_results(const CompareWork& work, const std::filesystem::path& out, CompareResult& result) {
  const Comparison& comparison = work.comparison;
  result.floors.clear();
  result.rows.clear();
  for (const std::optional<SceneWork>& scene : work.scenes) {
    if (!scene || scene->floor.scene.empty()) continue;
    result.floors.push_back(scene->floor);
    for (std::size_t s = 0; s < comparison.settings.size(); ++s)
      result.rows.push_back(row_of(*scene, comparison.settings[s].name, s));
  }
  rank(result.rows);
  write_file(out / "compare.json", compare_json(result));
  write_file(out / "compare.csv", compare_csv(result));
  write_file(out / "compare.txt", compare_table(result));
  if (!comparison.evaluation.baseline.empty()) {
    const Evaluation found = evaluated(comparison, result.floors, result.rows);
    result.evaluation = evaluation_text(found);
    write_file(out / "evaluation.txt", result.evaluation);
    write_file(out / "evaluation.json", evaluation_json(found));
  }
  write_file(out / "compare.html", compare_page(comparison, result));
}

// One page a scene that plays its rows side by side. It is an extra: nothing is lost where it cannot be made.
void write_views(const SceneWork& work, const std::filesystem::path& out, std::ostream* log, CompareResult& result) {
  if (!work.keeps) return;
  constexpr std::size_t most_rows = 4, most_bytes = 12'000'000;
  std::vector<std::filesystem::path> runs;
  for (std::size_t s = 0; s < work.setups.size() && runs.size() < most_rows; ++s)
    if (work.setups[s] && std::filesystem::exists(trajectory_of(work, s))) runs.push_back(trajectory_of(work, s));
  result.views = out / "views";
  make_folder(result.views);
  try {
    if (!runs.empty()) write_view(runs, result.views / (work.scene->name + ".html"), {.limit = most_bytes});
  } catch (const Error& error) {
    say(log, work.scene->name + ": no page that plays it: " + error.what());
  }
}

// The volume that rows leave, once all runs are there.
void add_volumes(const CompareWork& work, const std::filesystem::path& out, CompareResult& result) {
  const Comparison& comparison = work.comparison;
  if (!comparison.evaluation.volume || !result.finished) return;
  std::vector<KeptRun> runs;
  const std::string machine = machine_of_most(result.rows);
  for (const std::optional<SceneWork>& scene : work.scenes)
    for (std::size_t s = 0; s < comparison.settings.size(); ++s) {
      if (!scene || !scene->setups[s] || !std::filesystem::exists(trajectory_of(*scene, s))) continue;
      const std::string& setting = comparison.settings[s].name;
      const double ms = scene->machine == machine ? row_of(*scene, setting, s).ms : unknown;
      runs.push_back({setting, scene->scene->outfit, scene->scene->name, trajectory_of(*scene, s), 1000 / ms});
    }
  result.evaluation += write_volume_report(runs, comparison.evaluation.baseline, out);
}

// The tables of the repulsive layer, of the trainings that are there. False: stopped.
bool report_drapes(const CompareWork& work, const std::filesystem::path& out, CompareResult& result) {
  if (work.comparison.drapes.empty()) return true;
  result.views = out / "views";
  std::vector<MeasuredDrapes> all;
  for (const ComparedDrapes& one : work.comparison.drapes) {
    std::optional<MeasuredDrapes> made = read_for(work.comparison.file.string() + ": drapes `" + one.name + "`", [&] {
      return measured_drapes(one, result.views, work.request.log, work.request.stop);
    });
    if (!made) return false;
    if (!made->rows.empty()) write_file(out / (one.name + ".csv"), drape_table_csv(made->rows));
    all.push_back(std::move(*made));
    result.repulsion = repulsion_tables(all);
    result.repulsion_figures = repulsion_figures(all);
    write_file(out / "repulsion.txt", result.repulsion);
  }
  return true;
}

// Where errors of sequences are.
std::string sequences_of(const Comparison& comparison) { return comparison.file.string() + ": sequences"; }

// The scenes of `sequences`, if there are any.
void add_made_scenes(Comparison& comparison) {
  const std::string& training = comparison.sequences.training;
  if (training.empty() && comparison.sequences.count == 0) return;
  read_for(sequences_of(comparison),
           [&] { training.empty() ? add_sequences(comparison) : add_training_sequences(comparison); });
}

std::shared_ptr<CompareWork> read_work(const CompareRequest& request) {
  auto work = std::make_shared<CompareWork>();
  work->request = request;
  work->program = program_key();
  Comparison& comparison = work->comparison;
  comparison = read_comparison(request.file, request.short_form, request.overrides);
  comparison.kinds = request.kinds;
  add_made_scenes(comparison);
  for (const CompareScene& scene : comparison.scenes) work->names.push_back(cell_name(scene.name));
  number_equal_names(work->names);
  work->scenes.resize(comparison.scenes.size());
  return work;
}

SceneWork& scene_of(CompareWork& work, std::size_t k) {
  std::optional<SceneWork>& scene = work.scenes[k];
  if (!scene) {
    read_for(sequences_of(work.comparison), [&] {
      find_start(work.comparison, work.program, work.request.log, work.search, work.comparison.scenes[k]);
    });
    scene = open_scene(work.comparison, work.comparison.scenes[k], work.request.short_form, work.program);
    scene->keeps = static_cast<int>(k) < work.comparison.keep_runs;
  }
  return *scene;
}

// Absent: stopped.
std::optional<CellResult> run_scene_cell(CompareWork& work, std::size_t k, const std::filesystem::path& folder,
                                         const CellWatch& watch) {
  SceneWork& scene = scene_of(work, k);
  scene.folder = folder;
  if (!measure_scene(work.comparison, work.request.short_form, watch, scene)) return {};
  std::uint64_t positions = hash_of("");
  for (const std::vector<CompareRun>& runs : scene.runs)
    for (const CompareRun& run : runs) positions = hash_of(std::to_string(run.end), positions);
  return CellResult{part_json(scene.floor, scene.keys.reference), true, positions};
}

// Each run counts its own steps; references take 16 a frame, and as many again for the floor.
double rough_seconds_of(const Comparison& comparison, const SceneWork& work) {
  double sum = 0;
  for (const std::optional<Setup>& setup : work.setups) {
    if (!setup) continue;
    const int vertices = setup->scene.surface.vertex_count, frames = setup->run.frames;
    if (sum == 0 && work.scene->states > 0)
      sum = rough_seconds(vertices, 16.0 * frames + 32.0 * work.scene->states * work.scene->horizon);
    sum += comparison.repeats * rough_seconds(vertices, frames);
  }
  return sum;
}

// What a scene's cell has measured becomes part of the results.
void take_in(CompareWork& work, const CellRecord& record, const std::filesystem::path& out, CompareResult& result) {
  const auto found = std::ranges::find(work.names, record.cell);
  SceneWork& scene = scene_of(work, static_cast<std::size_t>(found - work.names.begin()));
  scene.folder = cell_folder(out, record.cell);
  read_measured(work.comparison, record.machine, scene);
  write_views(scene, out, work.request.log, result);
}

// What needs all scenes, or is not worth making for each.
void write_last(const CompareWork& work, const std::filesystem::path& out, CompareResult& result) {
  write_results(work, out, result);
  add_volumes(work, out, result);
  write_compare_hdf5(out / "compare.h5", result);
  result.plots = plot_comparison(result, out);
}

std::string result_text(const CompareResult& result, const std::filesystem::path& out) {
  return compare_table(result) + result.evaluation + result.repulsion + result.plots + "\n" +
         (out / "compare.html").string() + "\n";
}

CellTables gather_scenes(CompareWork& work, const std::vector<CellRecord>& records, const std::filesystem::path& out) {
  CompareResult result;
  report_drapes(work, out, result);
  for (const CellRecord& record : records) take_in(work, record, out, result);
  result.finished = records.size() == work.names.size();
  write_last(work, out, result);
  return {result_text(result, out), compare_json(result), true};
}

CellList list_of(const std::shared_ptr<CompareWork>& work) {
  CellList list;
  list.kind = "compare";
  list.program = work->program;
  list.names = work->names;
  list.keeps_parts = true;
  list.describe = [work](std::size_t k) {
    const SceneWork& scene = scene_of(*work, k);
    return WorkCell{work->names[k], needs_of(work->comparison, scene), rough_seconds_of(work->comparison, scene)};
  };
  list.key = [work](std::size_t k) { return key_of(work->comparison, scene_of(*work, k)); };
  list.run = [work](std::size_t k, const std::filesystem::path& folder, const CellWatch& watch) {
    return run_scene_cell(*work, k, folder, watch);
  };
  list.is_whole = [work](std::size_t k, const std::filesystem::path& folder, const CellRecord& record) {
    SceneWork& scene = scene_of(*work, k);
    scene.folder = folder;
    return read_measured(work->comparison, record.machine, scene);
  };
  list.gather = [work](const std::vector<CellRecord>& records, const std::filesystem::path& out) {
    return gather_scenes(*work, records, out);
  };
  return list;
}

}  // namespace

CellList compare_cells(const CompareRequest& request) { return list_of(read_work(request)); }

CompareResult compare(const CompareRequest& request) {
  const std::shared_ptr<CompareWork> work = read_work(request);
  if (!work->comparison.split_text.empty()) say(request.log, work->comparison.split_text);
  for (std::size_t k = 0; k < work->names.size(); ++k) scene_of(*work, k);  // errors before hours of work
  make_folder(request.out);
  CompareResult result;
  result.finished = report_drapes(*work, request.out, result);
  const CellWatch watch{request.log, request.stop, true};
  if (result.finished)
    result.finished = do_cells(list_of(work), request.out, watch, [&](const DoneCell& done) {
      if (done.kept) say(request.log, done.record.cell + ": kept from before");
      take_in(*work, done.record, request.out, result);
      write_results(*work, request.out, result);
    });
  write_last(*work, request.out, result);
  return result;
}

}  // namespace selvedge

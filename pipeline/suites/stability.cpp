#include "pipeline/suites/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "collision/geometry/error.hpp"
#include "physics/frame/frame_audits.hpp"
#include "pipeline/cells/do_cells.hpp"
#include "pipeline/cells/scene_cells.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/run_scene.hpp"
#include "pipeline/scene/make_stepper.hpp"
#include "pipeline/suites/kept_run.hpp"
#include "pipeline/suites/spoiled_weights.hpp"
#include "pipeline/suites/stability_suite.hpp"
#include "pipeline/suites/stability_watch.hpp"

namespace selvedge {
namespace {

std::vector<StabilityCase> chosen_cases(const StabilitySuite& suite, const StabilityRequest& request) {
  if (request.cases.empty()) return suite.cases;
  refuse_unknown(request.cases, names_of(suite.cases), "case", request.suite.string(), "cases");
  std::vector<StabilityCase> chosen;
  for (const std::string& name : request.cases)
    chosen.push_back(*std::ranges::find(suite.cases, name, &StabilityCase::name));
  return chosen;
}

// A cell: a run of a case.
struct StabilityCell {
  StabilityCase of;
  std::size_t number = 0;  // of the run in its case
  const StabilityRun& run() const { return of.runs[number]; }
  std::string folder() const { return fmt::format("{}_{}", of.name, number); }
};

struct StabilityWork {
  StabilityRequest request;
  StabilityLimits limits;
  std::vector<StabilityCell> cells;
  LastSetup last;
};

// `weights`: of the network; none where neither the request nor a fault of the run gives any.
Setup read_run(const StabilityRequest& request, const StabilityCell& cell,
               const std::optional<std::filesystem::path>& weights) {
  std::vector<std::string> overrides;
  if (request.stepper) overrides.push_back("run.stepper=" + *request.stepper);
  if (weights) overrides.push_back("run.learned.weights=" + quoted_yaml(std::filesystem::absolute(*weights).string()));
  overrides.insert(overrides.end(), cell.run().overrides.begin(), cell.run().overrides.end());
  return read_for(fmt::format("{}: run `{}` of case `{}`", request.suite.string(), cell.run().name, cell.of.name),
                  [&] { return read_setup(cell.of.scene, overrides, request.kinds); });
}

// With the fault of its run in the weights, which are then written to the file.
Setup read_faulty_run(const StabilityRequest& request, const StabilityCell& cell, const std::filesystem::path& file) {
  write_weight_file(file, spoiled_weights(read_weight_file(*request.weights), cell.run().fault));
  return read_run(request, cell, file);
}

const Setup& setup_of(StabilityWork& work, std::size_t k) {
  return work.last.get(k, [&] { return read_run(work.request, work.cells[k], work.request.weights); });
}

int frames_of(const RunSummary& summary, Verdict verdict) {
  const std::vector<int>& frames = total_of(summary.fields, "verdict").by_word;
  const auto k = static_cast<std::size_t>(verdict);
  return k < frames.size() ? frames[k] : 0;
}

// A bare network fails only for numbers that are not finite in an accepted state. Its row shows all other findings.
void judge_row(const RunSummary& summary, const StabilityLimits& limits, NetworkUse network, StabilityRow& row) {
  std::vector<std::string>& told = network == NetworkUse::alone ? row.told : row.failures;
  const auto fail_if = [&](bool bad, std::string why) {
    if (bad) told.push_back(std::move(why));
  };
  fail_if(summary.end != RunEnd::finished, fmt::format("ended in frame {} {}", summary.frames, summary.reason));
  if (row.nonfinite > 0) row.failures.push_back(fmt::format("{} numbers not finite", row.nonfinite));
  fail_if(!(row.unaccounted <= limits.growth * row.energy),
          fmt::format("energy grew by {:.3g} J from nowhere, {:.2g} % of the most there was", row.unaccounted,
                      100 * row.unaccounted / row.energy));
  fail_if(!(row.end_speed <= limits.speed),
          fmt::format("does not rest: {:.2g} % of the speed of a fall in the end", 100 * row.end_speed));
  fail_if(row.newton > limits.newton, fmt::format("{:.0f} Newton iterations a substep", row.newton));
  fail_if(row.linear > limits.linear, fmt::format("{:.0f} linear iterations a Newton iteration", row.linear));
  fail_if(row.clean_start && row.jumped == 0 && row.pairs > 0,
          fmt::format("{} intersecting pairs after a clean start", row.pairs));
  fail_if(row.clean_start && row.jumped > 0 && row.end_pairs + row.end_inside > 0,
          fmt::format("still {} pairs and {} vertices inside what jumped", row.end_pairs, row.end_inside));
  const auto passed_through = static_cast<long>(total_of(summary.fields, "passed_through").sum);
  fail_if(row.clean_start && row.jumped == 0 && passed_through > 0, fmt::format("{} passed through", passed_through));
}

// Absent: stopped before its end.
std::optional<CellResult> run_one(const StabilityWork& work, const StabilityCell& cell, const Setup& setup,
                                  const std::filesystem::path& folder, const CellWatch& cell_watch) {
  const Clock::time_point started = Clock::now();
  const std::optional<Start> start = prepare(setup, cell_watch.stop);
  if (!start) return {};
  StabilityRow row;
  row.name = cell.of.name;
  row.run = cell.run().name;
  row.vertices = setup.scene.surface.vertex_count;
  row.frames_wanted = setup.run.frames;
  std::unique_ptr<Stepper> stepper;
  try {
    stepper = make_stepper(setup);
  } catch (const Error& error) {
    row.failures = {error.what()};
    return CellResult{stability_row_json(row), false};
  }
  StabilityWatch watch(setup, start->state, stepper->traits());
  RunRequest to_run;
  to_run.out = folder;
  to_run.checkpoint_seconds = 1e9;
  to_run.stop = cell_watch.stop;
  to_run.observe = [&](const FrameEvent& event) {
    watch(event);
    if (event.state.frame < setup.run.frames) return;
    const Audit end = audit_positions(setup.scene, event.state.x, event.state.obstacles);
    row.end_pairs = end.intersecting_pairs();
    row.end_inside = end.inside_vertices;
  };
  const RunSummary summary = run_scene(setup, *start, *stepper, to_run);
  if (summary.end == RunEnd::interrupted) return {};
  row.stepper = stepper->traits().name;
  row.frames = summary.frames;
  const Audit found = audit_positions(setup.scene, start->state.x, start->state.obstacles);
  row.clean_start = found.intersecting_pairs() == 0 && found.inside_vertices == 0;
  row.pairs = summary.pairs;
  row.max_stretch = summary.max_stretch;
  row.notes = setup.warnings;
  row.proposed = frames_of(summary, Verdict::admitted) + frames_of(summary, Verdict::refined);
  static_cast<StabilityMeasures&>(row) = watch.measures();
  judge_row(summary, work.limits, setup.kind.network, row);
  row.seconds = seconds_since(started);
  keep_or_remove(folder, !row.passed(), cell_watch.log);
  return CellResult{stability_row_json(row), row.passed(), summary.positions_hash};
}

std::optional<CellResult> run_cell(StabilityWork& work, std::size_t k, const std::filesystem::path& folder,
                                   const CellWatch& watch) {
  const StabilityCell& cell = work.cells[k];
  const std::filesystem::path weights = folder / "faulty_weights.h5";
  const bool faulty = work.request.weights && !cell.run().fault.empty();
  std::optional<CellResult> result =
      faulty ? run_one(work, cell, read_faulty_run(work.request, cell, weights), folder / "run", watch)
             : run_one(work, cell, setup_of(work, k), folder / "run", watch);
  if (result && result->passed) std::filesystem::remove(weights);
  return result;
}

std::string log_line(const StabilityRow& row) {
  std::string line = fmt::format("{} {}: {}, {:.1f} s{}\n", row.name, row.run, row.passed() ? "passed" : "FAILED",
                                 row.seconds, row.kept ? " (kept from before)" : "");
  for (const auto* reasons : {&row.failures, &row.told})
    for (const std::string& why : *reasons) line += "  " + why + "\n";
  return line;
}

CellTables write_tables(const std::filesystem::path& out, const std::vector<StabilityRow>& rows) {
  const CellTables tables{stability_table(rows), stability_json(rows), passed(rows)};
  write_file(out / "stability.txt", tables.text);
  write_file(out / "stability.csv", stability_csv(rows));
  write_file(out / "stability.json", tables.json);
  write_file(out / "stability.md", stability_markdown(rows));
  return tables;
}

StabilityWork read_work(const StabilityRequest& request) {
  const StabilitySuite suite = read_stability_suite(request.suite);
  StabilityWork work{request, suite.limits, {}, {}};
  for (const StabilityCase& one : chosen_cases(suite, request))
    for (std::size_t k = 0; k < one.runs.size(); ++k)
      if (!request.short_form || one.runs[k].brief) work.cells.push_back({one, k});
  return work;
}

// The run of a cell under its cell's name.
void show_run(const std::filesystem::path& out, const std::string& cell) {
  show_result(cell_folder(out, cell) / "run", out / cell);
}

}  // namespace

CellList stability_cells(const StabilityRequest& request) {
  const auto work = std::make_shared<StabilityWork>(read_work(request));
  CellList list;
  list.kind = "stability";
  list.program = program_key();
  for (const StabilityCell& cell : work->cells) list.names.push_back(cell_name(cell.folder()));
  number_equal_names(list.names);
  list.describe = [work, names = list.names](std::size_t k) {
    const Setup& setup = setup_of(*work, k);
    std::vector<std::filesystem::path> needs = needs_of(setup);
    needs.push_back(work->request.suite);
    return WorkCell{names[k], needs, rough_seconds(setup.scene.surface.vertex_count, setup.run.frames)};
  };
  list.key = [work](std::size_t k) {
    const StabilityLimits& limits = work->limits;
    return fmt::format("{} {} {} {} {} {}", inputs_key(setup_of(*work, k)), limits.growth, limits.speed, limits.newton,
                       limits.linear, work->cells[k].run().fault);
  };
  list.run = [work](std::size_t k, const std::filesystem::path& folder, const CellWatch& watch) {
    return run_cell(*work, k, folder, watch);
  };
  list.gather = [](const std::vector<CellRecord>& records, const std::filesystem::path& out) {
    const auto show = [&](const StabilityRow&, const std::string& cell) { show_run(out, cell); };
    return write_tables(out, cell_rows(records, read_stability_row, show));
  };
  return list;
}

std::vector<StabilityRow> stability(const StabilityRequest& request) {
  const CellList list = stability_cells(request);
  for (std::size_t k = 0; k < list.names.size(); ++k) list.describe(k);  // errors before minutes of work
  std::vector<StabilityRow> rows;
  const auto show = [&](const StabilityRow& row, const std::string& cell) {
    show_run(request.out, cell);
    if (request.log) *request.log << log_line(row) << std::flush;
    write_tables(request.out, rows);
  };
  do_rows(list, request.out, {request.log, request.stop}, read_stability_row, show, rows);
  return rows;
}

bool passed(const std::vector<StabilityRow>& rows) { return std::ranges::all_of(rows, &StabilityRow::passed); }

}  // namespace selvedge

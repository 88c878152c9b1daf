#include "pipeline/suites/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "collision/geometry/error.hpp"
#include "physics/frame/frame_audits.hpp"
#include "pipeline/config/config.hpp"
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

std::filesystem::path weights_of(const StabilityRequest& request, const StabilityRun& run) {
  return run.fault.empty() ? *request.weights : request.out / ("weights_" + run.fault + ".h5");
}

void write_spoiled_weights(const StabilityRequest& request, const std::vector<StabilityCase>& cases) {
  const WeightFile file = read_weight_file(*request.weights);
  std::set<std::string> faults;
  for (const StabilityCase& one : cases)
    for (const StabilityRun& run : one.runs)
      if (!run.fault.empty()) faults.insert(run.fault);
  for (const std::string& fault : faults)
    write_weight_file(request.out / ("weights_" + fault + ".h5"), spoiled_weights(file, fault));
}

Setup read_run(const StabilityRequest& request, const StabilityCase& one, const StabilityRun& run) {
  std::vector<std::string> overrides;
  if (request.stepper) overrides.push_back("run.stepper=" + *request.stepper);
  if (request.weights)
    overrides.push_back("run.learned.weights=" +
                        quoted_yaml(std::filesystem::absolute(weights_of(request, run)).string()));
  overrides.insert(overrides.end(), run.overrides.begin(), run.overrides.end());
  return read_for(fmt::format("{}: run `{}` of case `{}`", request.suite.string(), run.name, one.name),
                  [&] { return read_setup(one.scene, overrides, request.kinds); });
}

int frames_of(const RunSummary& summary, Verdict verdict) {
  const std::vector<int>& frames = total_of(summary.fields, "verdict").by_word;
  const auto k = static_cast<std::size_t>(verdict);
  return k < frames.size() ? frames[k] : 0;
}

// Nothing but numbers that are none is held against a bare network: a step that it rejects has a reason, and what else
// there is to say of it is told.
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
std::optional<StabilityRow> run_one(const StabilityRequest& request, const StabilityLimits& limits,
                                    const StabilityCase& one, const StabilityRun& run,
                                    const std::filesystem::path& folder) {
  const Clock::time_point started = Clock::now();
  const Setup setup = read_run(request, one, run);
  const std::optional<Start> start = prepare(setup, request.stop);
  if (!start) return {};
  StabilityRow row;
  row.name = one.name;
  row.run = run.name;
  row.vertices = setup.scene.surface.vertex_count;
  row.frames_wanted = setup.run.frames;
  std::unique_ptr<Stepper> stepper;
  try {
    stepper = make_stepper(setup);
  } catch (const Error& error) {
    row.failures = {error.what()};
    return row;
  }
  StabilityWatch watch(setup, start->state, stepper->traits());
  RunRequest to_run;
  to_run.out = folder;
  to_run.checkpoint_seconds = 1e9;
  to_run.stop = request.stop;
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
  judge_row(summary, limits, setup.kind.network, row);
  row.seconds = seconds_since(started);
  keep_or_remove(folder, !row.passed(), request.log);
  return row;
}

std::string log_line(const StabilityRow& row) {
  std::string line =
      fmt::format("{} {}: {}, {:.1f} s\n", row.name, row.run, row.passed() ? "passed" : "FAILED", row.seconds);
  for (const auto* reasons : {&row.failures, &row.told})
    for (const std::string& why : *reasons) line += "  " + why + "\n";
  return line;
}

void write_tables(const std::filesystem::path& out, const std::vector<StabilityRow>& rows) {
  write_file(out / "stability.txt", stability_table(rows));
  write_file(out / "stability.csv", stability_csv(rows));
  write_file(out / "stability.json", stability_json(rows));
  write_file(out / "stability.md", stability_markdown(rows));
}

}  // namespace

std::vector<StabilityRow> stability(const StabilityRequest& request) {
  const StabilitySuite suite = read_stability_suite(request.suite);
  const std::vector<StabilityCase> cases = chosen_cases(suite, request);
  for (const StabilityCase& one : cases)
    for (const StabilityRun& run : one.runs) read_run(request, one, run);  // errors before minutes of work
  make_folder(request.out);
  if (request.weights) write_spoiled_weights(request, cases);
  std::vector<StabilityRow> rows;
  for (const StabilityCase& one : cases)
    for (std::size_t k = 0; k < one.runs.size(); ++k) {
      if (request.short_form && !one.runs[k].brief) continue;
      const auto row =
          run_one(request, suite.limits, one, one.runs[k], request.out / fmt::format("{}_{}", one.name, k));
      if (!row) return rows;
      rows.push_back(*row);
      write_tables(request.out, rows);
      if (request.log) *request.log << log_line(*row) << std::flush;
    }
  return rows;
}

bool passed(const std::vector<StabilityRow>& rows) { return std::ranges::all_of(rows, &StabilityRow::passed); }

}  // namespace selvedge

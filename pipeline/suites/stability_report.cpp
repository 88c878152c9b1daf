#include <fmt/format.h>

#include <algorithm>

#include "pipeline/host/json_csv.hpp"
#include "pipeline/host/kept_row_json.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/suites/stability.hpp"

namespace selvedge {
namespace {

// The fields of a row in its JSON.
constexpr auto stability_fields = [](auto& r, const auto& visit) {
  visit("case", r.name);
  visit("run", r.run);
  visit("passed", r.passed());
  visit("stepper", r.stepper);
  visit("vertices", r.vertices);
  visit("frames", r.frames);
  visit("frames_wanted", r.frames_wanted);
  visit("seconds", r.seconds);
  visit("nonfinite", r.nonfinite);
  visit("largest_energy", r.energy);
  visit("work_of_pins", r.work.pins);
  visit("work_of_obstacles", r.work.obstacles);
  visit("work_of_wind", r.work.wind);
  visit("work_of_response", r.work.response);
  visit("unaccounted_energy", r.unaccounted);
  visit("end_speed", r.end_speed);
  visit("newton_iterations", r.newton);
  visit("linear_iterations", r.linear);
  visit("clean_start", r.clean_start);
  visit("jumped", r.jumped);
  visit("intersecting_pairs", r.pairs);
  visit("end_pairs", r.end_pairs);
  visit("max_stretch", r.max_stretch);
  visit("proposed", r.proposed);
  visit("notes", r.notes);
  visit("told", r.told);
  visit("failures", r.failures);
};

double grown(const StabilityRow& row) { return row.energy > 0 ? 100 * row.unaccounted / row.energy : 0; }

long failed(const std::vector<StabilityRow>& rows) { return std::ranges::count(rows, false, &StabilityRow::passed); }

double seconds(const std::vector<StabilityRow>& rows) {
  double sum = 0;
  for (const StabilityRow& row : rows) sum += row.seconds;
  return sum;
}

std::string verdict_text(const StabilityRow& row) {
  const std::vector<std::string>& reasons = row.passed() ? row.told : row.failures;
  return (row.passed() ? "pass" : "FAIL") + (reasons.empty() ? "" : fmt::format(": {}", fmt::join(reasons, "; ")));
}

}  // namespace

std::string stability_table(const std::vector<StabilityRow>& rows) {
  std::string text =
      fmt::format("{:<12} {:<28} {:<5} {:>8} {:>6} {:>9} {:>9} {:>9} {:>8} {:>8} {:>6} {:>6} {:>7} {:>7}\n", "case",
                  "run", "", "vertices", "frames", "most J", "worked J", "growth %", "rest %", "Newton", "linear",
                  "pairs", "stretch", "seconds");
  for (const StabilityRow& row : rows) {
    text += fmt::format(
        "{:<12} {:<28} {:<5} {:>8} {:>6} {:>9.2g} {:>9.2g} {:>9.2g} {:>8.2g} {:>8.1f} {:>6.1f} {:>6} {:>7.3g} "
        "{:>7.1f}\n",
        row.name, row.run, row.passed() ? "pass" : "FAIL", row.vertices, row.frames, row.energy, row.work.total(),
        grown(row), 100 * row.end_speed, row.newton, row.linear, row.end_pairs, row.max_stretch, row.seconds);
    for (const auto* reasons : {&row.failures, &row.told})
      for (const std::string& why : *reasons) text += "    " + why + "\n";
  }
  return text + fmt::format("{} of {} pass, {:.0f} s\n", static_cast<long>(rows.size()) - failed(rows), rows.size(),
                            seconds(rows));
}

std::string stability_markdown(const std::vector<StabilityRow>& rows) {
  std::string text =
      "| case | run | | vertices | frames | most energy [J] | work at most [J] | growth % | rest % | Newton | linear "
      "| pairs at the end | stretch | s |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const StabilityRow& row : rows)
    text += fmt::format(
        "| {} | {} | {} | {} | {} | {:.2g} | {:.2g} | {:.2g} | {:.2g} | {:.1f} | {:.1f} | {} | {:.3g} | {:.1f} |\n",
        row.name, row.run, verdict_text(row), row.vertices, row.frames, row.energy, row.work.total(), grown(row),
        100 * row.end_speed, row.newton, row.linear, row.end_pairs, row.max_stretch, row.seconds);
  return text;
}

std::string stability_row_json(const StabilityRow& row) { return json_text(row_to_json(row, stability_fields)); }

std::optional<StabilityRow> read_stability_row(const std::string& text) {
  return read_fields<StabilityRow>(text, stability_fields);
}

std::string stability_csv(const std::vector<StabilityRow>& rows) {
  return csv_of_json(json_text(rows_to_json(rows, stability_fields)));
}

std::string stability_json(const std::vector<StabilityRow>& rows) {
  return json_text({{"program_version", program_version()},
                    {"passed", failed(rows) == 0},
                    {"seconds", seconds(rows)},
                    {"runs", rows_to_json(rows, stability_fields)}});
}

}  // namespace selvedge

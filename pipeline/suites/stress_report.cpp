#include <fmt/format.h>

#include <algorithm>

#include "pipeline/host/json_csv.hpp"
#include "pipeline/host/kept_row_json.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/suites/stress.hpp"

namespace selvedge {
namespace {

// The fields of a row in its JSON.
constexpr auto stress_fields = [](auto& r, const auto& visit) {
  visit("scene", r.scene);
  visit("repeat", r.repeat);
  visit("passed", r.passed());
  visit("seed", r.seed);
  visit("jitter", r.jitter);
  visit("vertices", r.vertices);
  visit("frames", r.frames);
  visit("frames_wanted", r.frames_wanted);
  visit("seconds", r.seconds);
  visit("intersecting_pairs", r.pairs);
  visit("vertex_sharing_pairs", r.vertex_pairs);
  visit("nonfinite", r.nonfinite);
  visit("worst_frame", r.worst_frame);
  visit("inside_vertices", r.worst_inside);
  visit("frames_touching_wanted", r.wanted_frames);
  visit("passed_through", r.passed_through);
  visit("impulses", r.impulses);
  visit("zones", r.zones);
  visit("shortened_zones", r.shortened);
  visit("held_share", r.held_share);
  visit("obstacle_lag", r.obstacle_lag);
  visit("max_stretch", r.max_stretch);
  visit("outcome", r.outcome);
  visit("failures", r.failures);
};

// Rows of one scene lie together.
template <class Each>
void for_each_scene(const std::vector<StressRow>& rows, const Each& each) {
  for (auto first = rows.begin(); first != rows.end();) {
    const auto last = std::find_if(first, rows.end(), [&](const StressRow& r) { return r.scene != first->scene; });
    each(std::vector<StressRow>(first, last));
    first = last;
  }
}

long failed(const std::vector<StressRow>& rows) { return std::ranges::count(rows, false, &StressRow::passed); }

std::string text_row(const StressRow& r) {
  return fmt::format(
      "{:<12} {:>3} {:>6} {:>8} {:>6} {:>7} {:>6} {:>7} {:>6} {:>8} {:>7.3f} {:>8.2g} {:>7.3f} {:>8.1f}\n", r.scene,
      r.repeat + 1, r.passed() ? "yes" : "NO", r.vertices, r.frames, r.pairs, r.vertex_pairs, r.worst_inside,
      r.nonfinite, r.passed_through, 100 * r.held_share, r.obstacle_lag, r.max_stretch, r.seconds);
}

}  // namespace

std::string stress_row_json(const StressRow& row) { return json_text(row_to_json(row, stress_fields)); }

std::optional<StressRow> read_stress_row(const std::string& text) {
  return read_fields<StressRow>(text, stress_fields);
}

std::string stress_json(const std::vector<StressRow>& rows) {
  Json scenes = Json::array();
  for_each_scene(rows, [&](const std::vector<StressRow>& of) {
    scenes.push_back(
        {{"scene", of[0].scene}, {"passed", failed(of) == 0}, {"repeats", of.size()}, {"failed", failed(of)}});
  });
  return json_text({{"program_version", program_version()},
                    {"passed", failed(rows) == 0},
                    {"scenes", scenes},
                    {"repeats", rows_to_json(rows, stress_fields)}});
}

std::string stress_csv(const std::vector<StressRow>& rows) {
  return csv_of_json(json_text(rows_to_json(rows, stress_fields)));
}

std::string stress_table(const std::vector<StressRow>& rows) {
  std::string text =
      fmt::format("{:<12} {:>3} {:>6} {:>8} {:>6} {:>7} {:>6} {:>7} {:>6} {:>8} {:>7} {:>8} {:>7} {:>8}\n", "scene", "",
                  "passed", "vertices", "frames", "pairs", "at vtx", "inside", "nonfin", "through", "held %", "lag [m]",
                  "stretch", "seconds");
  for (const StressRow& row : rows) text += text_row(row);
  text += "\n";
  for_each_scene(rows, [&](const std::vector<StressRow>& of) {
    text += fmt::format("{:<12} {} of {} passed\n", of[0].scene, static_cast<long>(of.size()) - failed(of), of.size());
    const auto bad = std::ranges::find(of, false, &StressRow::passed);
    for (const std::string& line : bad == of.end() ? of[0].outcome : bad->failures) text += "    " + line + "\n";
  });
  return text;
}

}  // namespace selvedge

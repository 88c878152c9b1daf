#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "pipeline/host/json_csv.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/suites/stress.hpp"

namespace selvedge {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const StressRow& r) {
  return {{"scene", r.scene},
          {"repeat", r.repeat},
          {"passed", r.passed()},
          {"seed", r.seed},
          {"jitter", r.jitter},
          {"vertices", r.vertices},
          {"frames", r.frames},
          {"frames_wanted", r.frames_wanted},
          {"seconds", r.seconds},
          {"intersecting_pairs", r.pairs},
          {"vertex_sharing_pairs", r.vertex_pairs},
          {"nonfinite", r.nonfinite},
          {"worst_frame", r.worst_frame},
          {"inside_vertices", r.worst_inside},
          {"frames_touching_wanted", r.wanted_frames},
          {"passed_through", r.passed_through},
          {"impulses", r.impulses},
          {"zones", r.zones},
          {"shortened_zones", r.shortened},
          {"held_share", r.held_share},
          {"obstacle_lag", r.obstacle_lag},
          {"max_stretch", r.max_stretch},
          {"outcome", r.outcome},
          {"failures", r.failures}};
}

StressRow from_json(const Json& j) {
  StressRow r;
  j.at("scene").get_to(r.scene);
  j.at("repeat").get_to(r.repeat);
  j.at("seed").get_to(r.seed);
  j.at("jitter").get_to(r.jitter);
  j.at("vertices").get_to(r.vertices);
  j.at("frames").get_to(r.frames);
  j.at("frames_wanted").get_to(r.frames_wanted);
  j.at("seconds").get_to(r.seconds);
  j.at("intersecting_pairs").get_to(r.pairs);
  j.at("vertex_sharing_pairs").get_to(r.vertex_pairs);
  j.at("nonfinite").get_to(r.nonfinite);
  j.at("worst_frame").get_to(r.worst_frame);
  j.at("inside_vertices").get_to(r.worst_inside);
  j.at("frames_touching_wanted").get_to(r.wanted_frames);
  j.at("passed_through").get_to(r.passed_through);
  j.at("impulses").get_to(r.impulses);
  j.at("zones").get_to(r.zones);
  j.at("shortened_zones").get_to(r.shortened);
  j.at("held_share").get_to(r.held_share);
  j.at("obstacle_lag").get_to(r.obstacle_lag);
  j.at("max_stretch").get_to(r.max_stretch);
  j.at("outcome").get_to(r.outcome);
  j.at("failures").get_to(r.failures);
  r.kept = true;
  return r;
}

// Rows of one scene lie together.
template <class Each>
void for_each_scene(const std::vector<StressRow>& rows, const Each& each) {
  for (auto first = rows.begin(); first != rows.end();) {
    const auto last = std::find_if(first, rows.end(), [&](const StressRow& r) { return r.scene != first->scene; });
    each(std::vector<StressRow>(first, last));
    first = last;
  }
}

long failed(const std::vector<StressRow>& rows) {
  return std::count_if(rows.begin(), rows.end(), [](const StressRow& r) { return !r.passed(); });
}

std::string text_row(const StressRow& r) {
  return fmt::format(
      "{:<12} {:>3} {:>6} {:>8} {:>6} {:>7} {:>6} {:>7} {:>6} {:>8} {:>7.3f} {:>8.2g} {:>7.3f} {:>8.1f}\n", r.scene,
      r.repeat + 1, r.passed() ? "yes" : "NO", r.vertices, r.frames, r.pairs, r.vertex_pairs, r.worst_inside,
      r.nonfinite, r.passed_through, 100 * r.held_share, r.obstacle_lag, r.max_stretch, r.seconds);
}

}  // namespace

std::string stress_row_json(const StressRow& row, const std::string& key) {
  Json json = {{"key", key}};
  json.update(to_json(row));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<StressRow> read_stress_row(const std::string& text, const std::string& key) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object() || json.value("key", "") != key) return {};
  try {
    return from_json(json);
  } catch (const Json::exception&) {
    return {};  // a file that another version has left
  }
}

std::string stress_json(const std::vector<StressRow>& rows) {
  Json scenes = Json::array(), repeats = Json::array();
  for (const StressRow& row : rows) repeats.push_back(to_json(row));
  for_each_scene(rows, [&](const std::vector<StressRow>& of) {
    scenes.push_back(
        {{"scene", of[0].scene}, {"passed", failed(of) == 0}, {"repeats", of.size()}, {"failed", failed(of)}});
  });
  const Json json = {
      {"program_version", program_version()}, {"passed", failed(rows) == 0}, {"scenes", scenes}, {"repeats", repeats}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string stress_csv(const std::vector<StressRow>& rows) {
  Json table = Json::array();
  for (const StressRow& row : rows) table.push_back(to_json(row));
  return csv_of_json(table.dump());
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
    const auto bad = std::find_if(of.begin(), of.end(), [](const StressRow& r) { return !r.passed(); });
    for (const std::string& line : bad == of.end() ? of[0].outcome : bad->failures) text += "    " + line + "\n";
  });
  return text;
}

}  // namespace selvedge

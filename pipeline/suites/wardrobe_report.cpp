#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "pipeline/host/json_csv.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/suites/wardrobe.hpp"

namespace selvedge {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const WardrobeRow& r) {
  return {{"wear", r.wear},
          {"clip", r.clip},
          {"passed", r.passed()},
          {"validation", r.validation},
          {"vertices", r.vertices},
          {"frames", r.frames},
          {"frames_wanted", r.frames_wanted},
          {"excused_frames", r.excused_frames},
          {"cloth_pairs", r.cloth_pairs},
          {"body_pairs", r.body_pairs},
          {"obstacle_lag", r.lag},
          {"depth", r.depth},
          {"milliseconds", r.milliseconds},
          {"seconds", r.seconds},
          {"max_stretch", r.max_stretch},
          {"failures", r.failures}};
}

WardrobeRow from_json(const Json& j) {
  WardrobeRow r;
  j.at("wear").get_to(r.wear);
  j.at("clip").get_to(r.clip);
  j.at("validation").get_to(r.validation);
  j.at("vertices").get_to(r.vertices);
  j.at("frames").get_to(r.frames);
  j.at("frames_wanted").get_to(r.frames_wanted);
  j.at("excused_frames").get_to(r.excused_frames);
  j.at("cloth_pairs").get_to(r.cloth_pairs);
  j.at("body_pairs").get_to(r.body_pairs);
  j.at("obstacle_lag").get_to(r.lag);
  j.at("depth").get_to(r.depth);
  j.at("milliseconds").get_to(r.milliseconds);
  j.at("seconds").get_to(r.seconds);
  j.at("max_stretch").get_to(r.max_stretch);
  j.at("failures").get_to(r.failures);
  r.kept = true;
  return r;
}

}  // namespace

std::string wardrobe_row_json(const WardrobeRow& row, const std::string& key) {
  Json json = {{"key", key}};
  json.update(to_json(row));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<WardrobeRow> read_wardrobe_row(const std::string& text, const std::string& key) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object() || json.value("key", "") != key) return {};
  try {
    return from_json(json);
  } catch (const Json::exception&) {
    return {};  // a file that another version has left
  }
}

std::string wardrobe_json(const std::vector<WardrobeRow>& rows) {
  Json list = Json::array();
  for (const WardrobeRow& row : rows) list.push_back(to_json(row));
  const bool passed = std::all_of(rows.begin(), rows.end(), [](const WardrobeRow& row) { return row.passed(); });
  const Json json = {{"program_version", program_version()}, {"passed", passed}, {"rows", list}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string wardrobe_csv(const std::vector<WardrobeRow>& rows) {
  Json table = Json::array();
  for (const WardrobeRow& row : rows) table.push_back(to_json(row));
  return csv_of_json(table.dump());
}

std::string wardrobe_table(const std::vector<WardrobeRow>& rows) {
  std::string text =
      fmt::format("{:<20} {:>8} {:>6} {:>7} {:>7} {:>7} {:>8} {:>11} {:>10} {:>8} {:>6}\n", "worn", "vertices", "clips",
                  "passed", "frames", "excused", "pairs", "body pairs", "depth [m]", "lag [m]", "ms");
  for (auto first = rows.begin(); first != rows.end();) {  // rows of one wear lie together
    const auto last = std::find_if(first, rows.end(), [&](const WardrobeRow& r) { return r.wear != first->wear; });
    WardrobeRow all;
    int passed = 0;
    for (auto row = first; row != last; ++row) {
      passed += row->passed();
      all.frames += row->frames;
      all.excused_frames += row->excused_frames;
      all.cloth_pairs += row->cloth_pairs;
      all.body_pairs += row->body_pairs;
      all.depth = std::max(all.depth, row->depth);
      all.lag = std::max(all.lag, row->lag);
      all.milliseconds += row->milliseconds / static_cast<double>(last - first);
    }
    text += fmt::format("{:<20} {:>8} {:>6} {:>7} {:>7} {:>7} {:>8} {:>11} {:>10.2g} {:>8.2g} {:>6.0f}\n", first->wear,
                        first->vertices, last - first, passed, all.frames, all.excused_frames, all.cloth_pairs,
                        all.body_pairs, all.depth, all.lag, all.milliseconds);
    for (auto row = first; row != last; ++row)
      for (const std::string& why : row->failures) text += fmt::format("    {}: {}\n", row->clip, why);
    first = last;
  }
  double seconds = 0;
  for (const WardrobeRow& row : rows) seconds += row.seconds;
  text += fmt::format("{} of {} rows passed, {:.1f} h in all\n", std::ranges::count_if(rows, &WardrobeRow::passed),
                      rows.size(), seconds / 3600);
  return text;
}

}  // namespace selvedge

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/host/json_csv.hpp"
#include "pipeline/host/kept_row_json.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/suites/wardrobe.hpp"

namespace selvedge {
namespace {

// The fields of a row in its JSON.
constexpr auto wardrobe_fields = [](auto& r, const auto& visit) {
  visit("wear", r.wear);
  visit("clip", r.clip);
  visit("passed", r.passed());
  visit("validation", r.validation);
  visit("vertices", r.vertices);
  visit("frames", r.frames);
  visit("frames_wanted", r.frames_wanted);
  visit("excused_frames", r.excused_frames);
  visit("cloth_pairs", r.cloth_pairs);
  visit("body_pairs", r.body_pairs);
  visit("obstacle_lag", r.lag);
  visit("depth", r.depth);
  visit("milliseconds", r.milliseconds);
  visit("seconds", r.seconds);
  visit("max_stretch", r.max_stretch);
  visit("failures", r.failures);
};

}  // namespace

std::string wardrobe_row_json(const WardrobeRow& row) { return json_text(row_to_json(row, wardrobe_fields)); }

std::optional<WardrobeRow> read_wardrobe_row(const std::string& text) {
  return read_fields<WardrobeRow>(text, wardrobe_fields);
}

std::string wardrobe_json(const std::vector<WardrobeRow>& rows) {
  return json_text({{"program_version", program_version()},
                    {"passed", std::ranges::all_of(rows, &WardrobeRow::passed)},
                    {"rows", rows_to_json(rows, wardrobe_fields)}});
}

std::string wardrobe_csv(const std::vector<WardrobeRow>& rows) {
  return csv_of_json(json_text(rows_to_json(rows, wardrobe_fields)));
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

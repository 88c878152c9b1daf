#include <fmt/format.h>

#include <algorithm>

#include "pipeline/cells/shot_cells.hpp"
#include "pipeline/host/json_csv.hpp"
#include "pipeline/host/kept_row_json.hpp"
#include "pipeline/host/version.hpp"

namespace selvedge {
namespace {

// The fields of a row in its JSON.
constexpr auto shot_fields = [](auto& r, const auto& visit) {
  visit("shot", r.shot);
  visit("scene", r.scene);
  visit("passed", r.passed);
  visit("vertices", r.vertices);
  visit("frames", r.frames);
  visit("frames_wanted", r.frames_wanted);
  visit("intersecting_pairs", r.pairs);
  visit("milliseconds", r.milliseconds);
  visit("seconds", r.seconds);
  visit("max_stretch", r.max_stretch);
  visit("reason", r.reason);
  visit("positions_hash", r.positions_hash);
};

}  // namespace

std::string shot_row_json(const ShotRow& row) { return json_text(row_to_json(row, shot_fields)); }

std::optional<ShotRow> read_shot_row(const std::string& text) { return read_fields<ShotRow>(text, shot_fields); }

std::string shots_json(const std::vector<ShotRow>& rows) {
  return json_text({{"program_version", program_version()},
                    {"passed", std::ranges::all_of(rows, &ShotRow::passed)},
                    {"shots", rows_to_json(rows, shot_fields)}});
}

std::string shots_csv(const std::vector<ShotRow>& rows) {
  return csv_of_json(json_text(rows_to_json(rows, shot_fields)));
}

std::string shots_table(const std::vector<ShotRow>& rows) {
  std::string text = fmt::format("{:<28} {:>6} {:>8} {:>6} {:>6} {:>8} {:>8} {:>8}\n", "shot", "clean", "vertices",
                                 "frames", "pairs", "stretch", "ms", "s");
  for (const ShotRow& row : rows) {
    text +=
        fmt::format("{:<28} {:>6} {:>8} {:>6} {:>6} {:>8.3f} {:>8.1f} {:>8.1f}\n", row.shot, row.passed ? "yes" : "NO",
                    row.vertices, row.frames, row.pairs, row.max_stretch, row.milliseconds, row.seconds);
    if (!row.reason.empty()) text += "    " + row.reason + "\n";
  }
  return text + fmt::format("{} of {} shots are clean\n", std::ranges::count_if(rows, &ShotRow::passed), rows.size());
}

}  // namespace selvedge

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/host/label_lines.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/tools/sew_garment.hpp"

namespace selvedge {
namespace {

constexpr double degrees = 180 / 3.14159265358979323846;

}  // namespace

std::string pattern_json(const PatternReport& report) {
  Json json = {{"panels", report.panels},
               {"seams", report.seams},
               {"stitches", report.stitches},
               {"area", report.area},
               {"least_angle", degrees * report.least_angle}};
  const SewnPattern& sewn = report.sewn;
  if (sewn.x.rows() > 0) {
    Json groups = Json::object();
    for (const auto& [name, vertices] : report.garment.groups) groups[name] = vertices.size();
    json.update({{"clean", is_clean(report)},
                 {"name", report.garment.name},
                 {"made_for", report.garment.made_for},
                 {"vertices", sewn.x.rows()},
                 {"triangles", sewn.triangles.rows()},
                 {"groups", groups},
                 {"pins", report.garment.pins.size()},
                 {"self_pairs", report.self_pairs},
                 {"body_pairs", report.body_pairs},
                 {"inside_vertices", report.inside_vertices},
                 {"largest_gap", report.largest_gap},
                 {"open_stitches", report.open_stitches},
                 {"joined_by", sewn.joined_by},
                 {"moving_share", sewn.moving_share},
                 {"at_rest", sewn.moving_share < resting_share},
                 {"slid_off_in", sewn.watch.left_in},
                 {"body_raised", report.raised},
                 {"faults", faults_of(report)},
                 {"body_moved", sewn.body_moved},
                 {"median_distance", report.median_distance},
                 {"strain_99", report.strain_99},
                 {"frames", {sewn.closing_frames, sewn.draping_frames}},
                 {"seconds", sewn.seconds}});
  }
  json["warnings"] = report.warnings;
  return json_text(json);
}

std::string pattern_text(const PatternReport& report) {
  LabelLines add{24};
  add("pattern", fmt::format("{}, {} of {}, {:.3g} m2", counted(report.panels, "panel"), counted(report.seams, "seam"),
                             counted(report.stitches, "stitch", "stitches"), report.area));
  add("smallest angle", fmt::format("{:.3g} degrees", degrees * report.least_angle));
  for (const std::string& warning : report.warnings) add("warning", warning);
  const SewnPattern& sewn = report.sewn;
  if (sewn.x.rows() == 0) return add.text;
  add("garment",
      fmt::format("{}: {}, {}, for the body {}", report.garment.name, counted(sewn.x.rows(), "vertex", "vertices"),
                  counted(sewn.triangles.rows(), "triangle"), report.garment.made_for));
  for (const auto& [name, vertices] : report.garment.groups)
    add("group " + name, counted(std::ssize(vertices), "vertex", "vertices"));
  add("gaps before joining", fmt::format("{:.3g} mm at most; joining moved vertices by {:.3g} mm",
                                         1e3 * report.largest_gap, 1e3 * sewn.joined_by));
  add(sewn.moving_share < resting_share ? "at rest" : "not at rest",
      fmt::format("{:.3g} % of vertices move in the last frame", 100 * sewn.moving_share));
  add("intersecting pairs", fmt::format("{} with itself, {} with the body", report.self_pairs, report.body_pairs));
  add("inside the body", counted(report.inside_vertices, "vertex", "vertices"));
  add("body parted from itself", fmt::format("by {:.3g} mm at most", 1e3 * sewn.body_moved));
  add("distance to the body", fmt::format("{:.3g} mm in the median", 1e3 * report.median_distance));
  add("strain", fmt::format("{:.3g} % in the 99th percentile", 100 * report.strain_99));
  add("frames",
      fmt::format("{} of sewing, {} of draping, {:.3g} s", sewn.closing_frames, sewn.draping_frames, sewn.seconds));
  if (report.raised > 0) add("floor", fmt::format("the soles of the body, {:.3g} m below its origin", report.raised));
  for (const std::string& fault : faults_of(report)) add("not good", fault);
  return add.text;
}

}  // namespace selvedge

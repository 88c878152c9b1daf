#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/host/label_lines.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/tools/dress.hpp"

namespace selvedge {
namespace {

std::string vertices_text(std::ptrdiff_t n) { return counted(n, "vertex", "vertices"); }

}  // namespace

std::string dress_json(const DressReport& report) {
  const Garment& garment = report.garment;
  Json groups = Json::object();
  for (const auto& [name, vertices] : garment.groups) groups[name] = vertices.size();
  return json_text({{"clean", is_clean(report)},
                    {"name", garment.name},
                    {"made_for", garment.made_for},
                    {"unit", report.frame.unit},
                    {"up", report.frame.up == Up::y ? "y" : "z"},
                    {"guessed", report.frame_reason},
                    {"welded", report.welded},
                    {"weldable", report.weldable},
                    {"vertices", garment.skin.rest.rows()},
                    {"triangles", garment.skin.triangles.rows()},
                    {"components", report.components},
                    {"groups", groups},
                    {"pinned_groups", report.pinned},
                    {"pins", garment.pins.size()},
                    {"least_distance", report.least_distance},
                    {"mean_distance", report.mean_distance},
                    {"on_body", report.on_body},
                    {"inside_vertices", report.inside_vertices},
                    {"self_pairs", report.self_pairs},
                    {"body_pairs", report.body_pairs},
                    {"reposed", report.reposed},
                    {"warnings", report.warnings}});
}

std::string dress_text(const DressReport& report) {
  const Garment& garment = report.garment;
  LabelLines add{24};
  add("garment",
      fmt::format("{}: {}, {}, pieces: {}, for the body {}", garment.name, vertices_text(garment.skin.rest.rows()),
                  counted(garment.skin.triangles.rows(), "triangle"), report.components, garment.made_for));
  add("unit and axis",
      frame_text(report.frame) + (report.frame_reason.empty() ? ", as given" : ", " + report.frame_reason));
  if (report.welded > 0) add("welded", vertices_text(report.welded) + " joined to others");
  for (const auto& [name, vertices] : garment.groups) add("group " + name, vertices_text(vertices.size()));
  add("pins", garment.pins.empty() ? "none" : vertices_text(garment.pins.size()) + ": " + joined(report.pinned));
  add("distance to the body",
      fmt::format("{:.4g} m at least, {:.4g} m on average", report.least_distance, report.mean_distance));
  add("inside the body", vertices_text(report.inside_vertices));
  add("intersecting pairs", fmt::format("{} with itself, {} with the body", report.self_pairs, report.body_pairs));
  add("put back into its pose", fmt::format("within {:.2g} m", report.reposed));
  for (const std::string& warning : report.warnings) add("warning", warning);
  return add.text;
}

}  // namespace selvedge

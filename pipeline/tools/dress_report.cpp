#include <fmt/format.h>

#include "pipeline/config/config.hpp"
#include "pipeline/host/label_lines.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/tools/dress.hpp"

namespace selvedge {

std::string dress_json(const DressReport& report) {
  const Garment& garment = report.garment;
  nlohmann::ordered_json groups = nlohmann::ordered_json::object();
  for (const auto& [name, vertices] : garment.groups) groups[name] = vertices.size();
  return json_text({{"clean", is_clean(report)},
                    {"name", garment.name},
                    {"made_for", garment.made_for},
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
      fmt::format("{}: {} vertices, {} triangles, pieces: {}, for the body {}", garment.name, garment.skin.rest.rows(),
                  garment.skin.triangles.rows(), report.components, garment.made_for));
  for (const auto& [name, vertices] : garment.groups) add("group " + name, fmt::format("{} vertices", vertices.size()));
  add("pins",
      garment.pins.empty() ? "none" : fmt::format("{} vertices: {}", garment.pins.size(), joined(report.pinned)));
  add("distance to the body",
      fmt::format("{:.4g} m at least, {:.4g} m on average", report.least_distance, report.mean_distance));
  add("inside the body", fmt::format("{} vertices", report.inside_vertices));
  add("intersecting pairs", fmt::format("{} with itself, {} with the body", report.self_pairs, report.body_pairs));
  add("put back into its pose", fmt::format("within {:.2g} m", report.reposed));
  for (const std::string& warning : report.warnings) add("warning", warning);
  return add.text;
}

}  // namespace selvedge

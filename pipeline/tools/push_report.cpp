#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/tools/push_mesh.hpp"

namespace selvedge {
namespace {

Json errors_as_json(const GarmentErrors& errors) {
  return {{"mpve_mm", number_or_null(errors.vertex_error)},
          {"vfcp_percent", errors.vertices_inside},
          {"collision_free", errors.collision_free},
          {"judges_agree", errors.judges_agree},
          {"pairs", errors.pairs},
          {"triangles_vertex_face", errors.vertex_face},
          {"triangles_edge_edge", errors.edge_edge},
          {"energy_m2", errors.energy},
          {"laplacian_error_mm", number_or_null(errors.laplacian_error)},
          {"overshoot_mm", number_or_null(errors.overshoot)}};
}

}  // namespace

std::string push_json(const PushReport& report) {
  return json_text({{"vertices", report.vertices},
                    {"triangles", report.triangles},
                    {"body_triangles", report.body_triangles},
                    {"body_closed", report.body_closed},
                    {"body_crosses_itself", report.body_crosses_itself},
                    {"before", errors_as_json(report.before)},
                    {"after", errors_as_json(report.after)},
                    {"pushed", report.pushed},
                    {"deep", report.deep},
                    {"torn", report.torn},
                    {"projected", report.projected},
                    {"edges_moved", report.edges},
                    {"faces_moved", report.faces},
                    {"seconds_distance", report.seconds_distance},
                    {"seconds_push", report.seconds_push},
                    {"seconds_edges", report.seconds_edges},
                    {"warnings", report.warnings}});
}

std::string push_text(const PushReport& report) {
  std::string text =
      fmt::format("garment of {} and {}, body of {}{}{}\n", counted(report.vertices, "vertex", "vertices"),
                  counted(report.triangles, "triangle"), counted(report.body_triangles, "triangle"),
                  report.body_closed ? "" : ", open", report.body_crosses_itself ? ", through itself" : "");
  text += "\nbefore\n" + errors_text(report.before) + "\nafter\n" + errors_text(report.after);
  text += fmt::format("\npushed {} ({} deep, {} torn, {} projected again), {} and {} passed\n",
                      counted(report.pushed, "vertex", "vertices"), report.deep, counted(report.torn, "edge"),
                      report.projected, counted(report.edges, "edge"), counted(report.faces, "face"));
  text += fmt::format("distances {:.2f} ms, push {:.2f} ms, edges {:.2f} ms\n", 1e3 * report.seconds_distance,
                      1e3 * report.seconds_push, 1e3 * report.seconds_edges);
  for (const std::string& warning : report.warnings) text += "warning: " + warning + "\n";
  return text;
}

}  // namespace selvedge

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "pipeline/host/label_lines.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/tools/untangle_mesh.hpp"

namespace selvedge {

std::string untangle_json(const UntangleReport& report) {
  const UntangleResult& r = report.result;
  Json left = Json::array();
  for (const Remainder& one : r.left)
    left.push_back({{"pairs", one.pairs}, {"length", one.length}, {"reason", one.reason}});
  return json_text({{"clean", is_clean(report)},
                    {"vertices", report.vertices},
                    {"triangles", report.triangles},
                    {"bodies", report.bodies},
                    {"pairs_before", r.pairs_before},
                    {"pairs_after", r.pairs_after},
                    {"audited_pairs", report.audited_pairs},
                    {"vertex_sharing_pairs_before", r.vertex_pairs_before},
                    {"vertex_sharing_pairs_after", r.vertex_pairs_after},
                    {"inside_before", report.inside_before},
                    {"inside_after", report.inside_after},
                    {"contour_length_before", r.length_before},
                    {"contour_length_after", r.length_after},
                    {"left", left},
                    {"iterations", r.iterations},
                    {"mean_edge", report.mean_edge},
                    {"moved", r.moved},
                    {"mean_move", r.mean_move},
                    {"max_move", r.max_move},
                    {"far_move", r.far_move},
                    {"min_stretch", r.least_stretch},
                    {"max_stretch", r.largest_stretch},
                    {"degenerate_before", report.degenerate_before},
                    {"degenerate_after", report.degenerate_after},
                    {"seconds", report.seconds},
                    {"warnings", report.warnings}});
}

std::string untangle_text(const UntangleReport& report) {
  const UntangleResult& r = report.result;
  LabelLines add{22};
  add("mesh", fmt::format("{}, {}, {}", counted(report.vertices, "vertex", "vertices"),
                          counted(report.triangles, "triangle"), counted(report.bodies, "body", "bodies")));
  add("intersecting pairs", fmt::format("{} before, {} after", r.pairs_before, r.pairs_after));
  add("crossing at a vertex", fmt::format("{} before, {} after", r.vertex_pairs_before, r.vertex_pairs_after));
  add("inside bodies", fmt::format("{} before, {} after", report.inside_before, report.inside_after));
  add("length of contours", fmt::format("{:.4g} m before, {:.4g} m after", r.length_before, r.length_after));
  add("audit", counted(report.audited_pairs, "pair"));
  add("moved", fmt::format("{}, by {:.3g} mean edges on average and {:.3g} at most",
                           counted(r.moved, "vertex", "vertices"), r.mean_move, r.max_move));
  add("stretch", fmt::format("{:.4f} to {:.4f} of the input", r.least_stretch, r.largest_stretch));
  add("degenerate triangles", fmt::format("{} before, {} after", report.degenerate_before, report.degenerate_after));
  add("time", fmt::format("{}, {:.2f} s", counted(r.iterations, "iteration"), report.seconds));
  for (const Remainder& left : r.left)
    add("left", fmt::format("{}, {:.3g} m: {}", counted(left.pairs, "pair"), left.length, left.reason));
  for (const std::string& warning : report.warnings) add("warning", warning);
  return add.text;
}

}  // namespace selvedge

#include <fmt/format.h>

#include <cmath>

#include "collision/geometry/counted.hpp"
#include "pipeline/host/label_lines.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/measures/run_measures.hpp"
#include "pipeline/tools/check.hpp"

namespace selvedge {
namespace {

Json opinion_json(const Opinion& opinion) {
  Json list = Json::array();
  for (const Disagreement& d : opinion.disagreements)
    list.push_back({{"frame", d.frame},
                    {"triangle", d.first},
                    {"other", d.second},
                    {"other_is_body", d.with_body},
                    {"intersect", d.ours},
                    {"margin", number_or_null(d.margin)},
                    {"beyond_rounding", d.beyond}});
  return {{"intersecting_pairs_by_frame", opinion.pairs_by_frame},
          {"frames_not_free_of_bodies", opinion.frames_against_body},
          {"beyond_rounding", opinion.beyond_rounding},
          {"disagreements", list}};
}

Json volume_json(const VolumeFindings& findings) {
  return {{"mean_net_loss", findings.mean_net_loss()},
          {"mean_loss", findings.mean_loss()},
          {"loss_of_fans", findings.of_fans},
          {"share_above_0.1", findings.share_above(0.1)},
          {"share_above_0.01", findings.share_above(0.01)},
          {"loss_by_frame", findings.loss_by_frame},
          {"volume_by_frame", findings.volume_by_frame},
          {"pairs", findings.pairs},
          {"contours", findings.contours},
          {"enclosed", findings.enclosed},
          {"open", findings.open},
          {"not_orientable", findings.not_orientable},
          {"unassigned", findings.unassigned},
          {"closed_holes", findings.closed_holes}};
}

}  // namespace

std::string check_json(const CheckReport& r) {
  Json json = {{"kind", r.trajectory ? "trajectory" : "mesh"},
               {"clean", is_clean(r)},
               {"closed", r.closed},
               {"frames", r.frames()},
               {"vertices", r.vertices},
               {"triangles", r.triangles},
               {"bodies", r.bodies},
               {"intersecting_pairs", r.worst_pairs},
               {"worst_frame", r.worst_frame},
               {"intersecting_pairs_by_frame", r.pairs_by_frame},
               {"vertex_sharing_pairs", r.worst_vertex_pairs},
               {"vertex_sharing_pairs_by_frame", r.vertex_pairs_by_frame},
               {"min_gap", number_or_null(r.min_gap)},
               {"max_stretch", number_or_null(r.max_stretch)},
               {"min_stretch", number_or_null(r.min_stretch)},
               {"nonfinite", r.nonfinite},
               {"degenerate_triangles", r.degenerate_triangles},
               {"inside_vertices", r.inside_vertices},
               {"warnings", r.warnings}};
  if (r.fcl) json["fcl"] = opinion_json(*r.fcl);
  if (r.volume) json["volume"] = volume_json(*r.volume);
  for (const auto& [name, value] : r.measures) json["measures"][name] = number_or_null(value);
  return json_text(json);
}

std::string check_text(const CheckReport& r) {
  LabelLines add{22};
  add(r.trajectory ? "trajectory" : "mesh",
      fmt::format("{}, {}, {}, {}", counted(r.frames(), "frame"), counted(r.vertices, "vertex", "vertices"),
                  counted(r.triangles, "triangle"), counted(r.bodies, "body", "bodies")));
  add("intersecting pairs",
      r.worst_pairs == 0 ? "0 in every frame" : fmt::format("{} in frame {}", r.worst_pairs, r.worst_frame));
  add("crossing at a vertex", counted(r.worst_vertex_pairs, "pair") + " in the worst frame");
  add("inside bodies", counted(r.inside_vertices, "vertex", "vertices") + " in the worst frame");
  add("smallest gap", std::isfinite(r.min_gap) ? fmt::format("{:.3g} m", r.min_gap) : "above the horizon");
  if (r.max_stretch) add("stretch", fmt::format("{:.4f} to {:.4f}", *r.min_stretch, *r.max_stretch));
  add("not finite", counted(r.nonfinite, "vertex", "vertices"));
  add("degenerate triangles", fmt::format("{}", r.degenerate_triangles));
  if (r.fcl) add("FCL's result", opinion_text(*r.fcl));
  if (r.volume) add("enclosed volume", volume_text(*r.volume));
  for (const auto& [name, value] : r.measures) add(name, fmt::format("{:<12.6g} {}", value, meaning_of(name)));
  for (const std::string& warning : r.warnings) add("warning", warning);
  return add.text;
}

}  // namespace selvedge

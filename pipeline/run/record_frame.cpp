#include "pipeline/run/record_frame.hpp"

#include <set>

#include "physics/frame/frame_audits.hpp"

namespace selvedge {
namespace {

void record_audit(const Audit& result, Frame& frame) {
  frame.self_pairs = static_cast<int>(result.self_pairs.size());
  frame.vertex_pairs = static_cast<int>(result.vertex_pairs.size());
  frame.obstacle_pairs = static_cast<int>(result.obstacle_pairs.size());
  frame.inside_vertices = result.inside_vertices;
  frame.nonfinite = result.nonfinite;
  std::set<int> bad;
  for (const auto* pairs : {&result.self_pairs, &result.vertex_pairs})
    for (const auto& [a, b] : *pairs) bad.insert({a, b});
  for (const auto& [triangle, other] : result.obstacle_pairs) bad.insert(triangle);
  frame.bad_triangles.assign(bad.begin(), bad.end());
}

}  // namespace

Frame record_frame(const Scene& scene, const EnergyTerms& terms, const FrameEvent& event) {
  const Clock::time_point started = Clock::now();
  Frame frame;
  frame.time = event.state.time;
  frame.x = event.state.x.cast<float>();
  const Points x = frame.x.cast<double>();
  for (const Points& obstacle : event.state.obstacles) frame.obstacles.push_back(obstacle.cast<float>());
  frame.report = event.report;
  const Clock::time_point before_audit = Clock::now();
  record_audit(event.report.audit ? *event.report.audit : audit_uncut(scene, event.state), frame);
  frame.report.seconds.audit += seconds_since(before_audit);
  Stretches stretches = principal_stretches(terms.membrane, scene.surface.triangles.rows(), x);
  // Cut-out triangles follow the body; their stretches do not count.
  for (const int t : event.state.cut_out) stretches.row(t).setOnes();
  if (stretches.rows() > 0) {
    frame.min_stretch = stretches.col(0).minCoeff();
    frame.max_stretch = stretches.col(1).maxCoeff();
  }
  frame.energy = energies(scene, terms, x, event.state.v, event.drive.acceleration);
  frame.seconds = event.seconds + seconds_since(started);
  return frame;
}

Frame record_initial(const Scene& scene, const EnergyTerms& terms, const State& state, const Drive& drive) {
  StepReport report;
  report.status = StepStatus::accepted;
  report.by = "initial";
  report.collision.cut_out = static_cast<int>(state.cut_out.size());
  return record_frame(scene, terms, {state, drive, report, 0});
}

}  // namespace selvedge

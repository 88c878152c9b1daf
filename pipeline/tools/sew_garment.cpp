#include "pipeline/tools/sew_garment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "collision/audit/audit.hpp"
#include "collision/distance/signed_distance.hpp"
#include "collision/geometry/box_diagonal.hpp"
#include "physics/energies/measures.hpp"
#include "pipeline/bodies/skin_places.hpp"
#include "pipeline/bodies/up_axis.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/garments/garment_hdf5.hpp"
#include "pipeline/garments/garment_places.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/host/lower_extension.hpp"
#include "pipeline/measures/motion_measures.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/patterns/stand_round.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/scene/materials.hpp"
#include "pipeline/shapes/outward_mesh.hpp"
#include "pipeline/shapes/own_crossings.hpp"

namespace selvedge {
namespace {

// A stitch with a larger gap did not close [m]. In good garments gaps were at most 0.2 mm.
constexpr double open_gap = 5e-3;

bool is_mesh(const std::filesystem::path& file) {
  return lower_extension(file) == ".obj" || lower_extension(file) == ".ply";
}

// A body with one joint that carries all of it.
BodyModel body_of_mesh(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  Mesh mesh = read_mesh(file);
  warnings.insert(warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
  turn_outward(file.string(), mesh, warnings);
  warn_of_crossings(file.string(), mesh, warnings);
  BodyModel body;
  body.name = file.stem().string();
  body.skin.rest = mesh.x;
  body.skin.triangles = mesh.triangles;
  const Eigen::Index n = mesh.x.rows();
  body.skin.weights = SkinWeights(Eigen::MatrixXd::Ones(n, 1).sparseView());
  body.skin.shape_directions.resize(3 * n, 0);
  body.skin.pose_directions.resize(3 * n, 0);
  body.joints = {"root"};
  body.parents = {-1};
  body.regressor = SkinWeights(Eigen::MatrixXd::Constant(1, n, 1.0 / static_cast<double>(n)).sparseView());
  warn_of_axis(file.string(), body, warnings);
  return body;
}

BodyModel body_to_sew_on(const PatternRequest& request, std::vector<std::string>& warnings) {
  if (is_mesh(request.body)) return body_of_mesh(request.body, warnings);
  Performance who =
      read_performance(read_values(table::body_section(), {{"model", "--body " + request.body, {request.body}}}), {});
  warnings.insert(warnings.end(), who.warnings.begin(), who.warnings.end());
  return std::move(who.body);
}

// The unit of a pattern is a number in its file, which is easily wrong.
void warn_of_size(const Pattern& pattern, const PatternMesh& mesh, std::vector<std::string>& warnings) {
  constexpr double smallest = 0.05, largest = 10;  // of the largest panel [m]
  double widest = 0;
  std::size_t which = 0;
  for (std::size_t p = 0, v = 0; p < pattern.panels.size(); ++p) {
    const std::size_t begin = v;
    while (v < mesh.panel.size() && mesh.panel[v] == static_cast<int>(p)) ++v;
    const double extent =
        box_diagonal(mesh.placed.middleRows(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(v - begin)));
    if (extent > widest) which = p;
    widest = std::max(widest, extent);
  }
  if (widest < smallest || widest > largest)
    warnings.push_back(fmt::format("the largest panel, `{}`, spans {:.3g} m: is `units_in_meter` right?",
                                   pattern.panels[which].name, widest));
}

// Records the sewing as a trajectory of the panels, which has one topology.
class SewingRecorder {
 public:
  SewingRecorder(const PatternRequest& request, const PatternMesh& mesh, const Points& body, const Triangles& triangles)
      : body_(body) {
    Scene scene;
    add_cloth(scene, mesh.placed, mesh.triangles, {}, request.file.stem(), mesh.rest);
    add_obstacle(scene, static_cast<int>(body.rows()), triangles, false, "body");
    writer_ =
        std::make_unique<TrajectoryWriter>(request.record, trajectory_info(scene, "", "sewing", SewingOptions{}.fps));
    SewingFrame first;
    first.x = &mesh.placed;
    add(first);
  }
  void add(const SewingFrame& seen) {
    Frame frame;
    frame.time = seen.time;
    frame.x = seen.x->cast<float>();
    frame.obstacles = {body_.cast<float>()};
    if (seen.report) frame.report = *seen.report;
    if (seen.report && seen.report->audit) {
      frame.self_pairs = static_cast<int>(seen.report->audit->self_pairs.size());
      frame.obstacle_pairs = static_cast<int>(seen.report->audit->obstacle_pairs.size());
    }
    writer_->append(frame);
  }
  void close() { writer_->close(); }

 private:
  const Points& body_;
  std::unique_ptr<TrajectoryWriter> writer_;
};

Garment garment_of(const PatternRequest& request, const Pattern& pattern, const SewnPattern& sewn,
                   const BodyModel& body) {
  Garment garment;
  garment.name = pattern.name;
  garment.made_for = body.name;
  garment.skin = attached(sewn.x, sewn.triangles, body, Fit::loose);
  garment.flat = sewn.rest;
  garment.groups = sewn.groups;
  std::vector<std::string> taken;
  for (const auto& [name, vertices] : garment.groups) taken.push_back(name);
  if (body.joints.size() > 1)
    for (NamedLoop& loop : named_loops(garment.skin, body, taken))
      garment.groups.emplace_back(loop.name, loop.vertices);
  garment.pins = pins_of(garment, request.pins);
  return garment;
}

// Measures the garment as it is written, against the body as it was given.
void measure(const BodyModel& body, PatternReport& report) {
  const SewnPattern& sewn = report.sewn;
  Scene scene;
  add_cloth(scene, sewn.x, sewn.triangles, {}, "garment", sewn.rest);
  const auto stretches = principal_stretches(scene, sewn.x);
  std::vector<double> strains;
  for (Eigen::Index t = 0; t < stretches.rows(); ++t) strains.push_back(stretches(t, 1) - 1);
  report.strain_99 = percentile(strains, 0.99);
  const Surface surface = closed_surface(body).surface;
  const std::vector<AuditBody> bodies{{&surface, &body.skin.rest}};
  const Audit found = audit(scene.surface, sewn.x, bodies);
  report.self_pairs = static_cast<int>(found.self_pairs.size() + found.vertex_pairs.size());
  report.body_pairs = static_cast<int>(found.obstacle_pairs.size());
  report.inside_vertices = found.inside_vertices;
  for (const double gap : sewn.gaps) {
    report.largest_gap = std::max(report.largest_gap, gap);
    report.open_stitches += gap > open_gap;
  }
  DistanceField field(surface);
  field.move_to(body.skin.rest);
  std::vector<double> distances;
  for (const SignedDistance& distance : field.ask(sewn.x)) distances.push_back(distance.value);
  report.median_distance = percentile(distances, 0.5);
}

}  // namespace

PatternReport sew_garment(const PatternRequest& request) {
  if (!is_mesh(request.out)) h5::check_out_name(request.out, "garments");
  const Pattern pattern = read_pattern(request.file);
  PatternMesh mesh = read_for(request.file.string(), [&] { return pattern_mesh(pattern, request.edge); });
  PatternReport report;
  report.panels = static_cast<int>(pattern.panels.size());
  report.seams = static_cast<int>(pattern.seams.size());
  report.stitches = static_cast<int>(mesh.sewn.size());
  report.least_angle = mesh.least_angle;
  for (const RestTriangle& triangle : mesh.rest) report.area += area(triangle);
  warn_of_size(pattern, mesh, report.warnings);
  if (request.flat) {
    write_mesh(request.out, mesh.placed, mesh.triangles);
    return report;
  }
  const BodyModel body = body_to_sew_on(request, report.warnings);
  report.raised = below_floor(body.skin.rest);
  mesh.placed.col(1).array() -= report.raised;
  check_stands_round(mesh, body.skin.rest, request.file.string());
  SewingOptions options;
  Config material =
      read_values(table::material_section(), {{"name", "--material " + request.material, {request.material}}});
  options.material = read_material(material, {});
  std::unique_ptr<SewingRecorder> recorder;
  if (!request.record.empty())
    recorder = std::make_unique<SewingRecorder>(request, mesh, body.skin.rest, body.skin.triangles);
  report.sewn = sew_pattern(mesh, body.skin.rest, body.skin.triangles, options, [&](const SewingFrame& frame) {
    if (recorder) recorder->add(frame);
    if (request.progress) request.progress(frame);
  });
  report.sewn.watch.garment = pattern.name;
  report.sewn.watch.body = body.name;
  if (recorder) recorder->close();
  measure(body, report);
  report.garment = garment_of(request, pattern, report.sewn, body);
  if (is_mesh(request.out))
    write_mesh(request.out, report.sewn.x, report.sewn.triangles);
  else
    write_garment(request.out, report.garment);
  return report;
}

std::vector<std::string> faults_of(const PatternReport& report) {
  const SewnPattern& sewn = report.sewn;
  std::vector<std::string> all;
  if (sewn.rejected) all.emplace_back("a step found no finite end");
  if (report.open_stitches > 0)
    all.push_back(
        fmt::format("{} of {} stitches never closed, {:.3g} mm apart at most; joining them distorts the garment; "
                    "are the edges too long, or has the body another shape?",
                    report.open_stitches, report.stitches, 1e3 * report.largest_gap));
  if (sewn.watch.part.places.empty())
    all.emplace_back("the garment is not on the body where its stitches have closed: it is sewn round nothing");
  else if (sewn.watch.left_in >= 0)
    all.push_back(slid_off_text(sewn.watch) +
                  ": nothing holds it there; is it too wide, or has the body another shape?");
  else if (!sewn.rejected && sewn.moving_share >= resting_share)
    all.push_back(fmt::format("the garment never came to rest: {:.3g} % of its vertices move in the last frame",
                              100 * sewn.moving_share));
  return all;
}

bool is_clean(const PatternReport& report) {
  return report.self_pairs + report.body_pairs + report.inside_vertices == 0 && faults_of(report).empty();
}

}  // namespace selvedge

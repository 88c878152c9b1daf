#include "pipeline/tools/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "collision/audit/audit.hpp"
#include "collision/geometry/error.hpp"
#include "collision/search/obstacle.hpp"
#include "physics/energies/measures.hpp"
#include "physics/scene/make_scene.hpp"
#include "pipeline/formats/mesh_faults.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/formats/seam_places.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/shapes/outward_mesh.hpp"
#include "pipeline/tools/check_measures.hpp"

namespace selvedge {
namespace {

constexpr const char* weld_keys_text = "`weld: true` in a scene, or `selvedge dress --weld` for a garment,";

struct Bodies {
  std::vector<Surface> surfaces;
  std::vector<Points> points;

  void add(Surface surface, Points x) {
    surfaces.push_back(std::move(surface));
    points.push_back(std::move(x));
  }
  std::vector<AuditBody> for_audit() const {
    std::vector<AuditBody> bodies;
    for (std::size_t k = 0; k < surfaces.size(); ++k) bodies.push_back({&surfaces[k], &points[k]});
    return bodies;
  }
};

void add_body_files(const CheckRequest& request, Bodies& bodies, CheckReport& report) {
  for (const std::filesystem::path& file : request.bodies) {
    Mesh mesh = read_mesh(file);
    for (const std::string& warning : mesh.warnings) report.warnings.push_back(file.string() + ": " + warning);
    turn_outward(file.string(), mesh, report.warnings);
    Surface surface = closed_surface({&mesh.x, 1}, mesh.triangles).surface;
    bodies.add(std::move(surface), std::move(mesh.x));
  }
}

// A triangle without a plane: the rounding of its coordinates hides its height.
bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return !((b - a).cross(c - a).norm() > 1e-10 * longest);
}

// Widens the search until it finds something, because its cost grows with the square of the distance.
double smallest_gap(const Surface& surface, const Points& x, const std::vector<AuditBody>& bodies, double horizon) {
  for (double distance = horizon / 64;; distance = std::min(4 * distance, horizon)) {
    const double gap = min_gap(surface, x, bodies, distance);
    if (std::isfinite(gap) || distance >= horizon) return gap;
  }
}

// `rest` is the scene for principal_stretches. Without a rest shape it has no rest triangles.
void check_frame(const Scene& rest, const Points& x, const Bodies& bodies, double horizon,
                 const std::optional<VolumeCheck>& volume, CheckReport& report) {
  const std::vector<AuditBody> audited = bodies.for_audit();
  const Audit found = audit(rest.surface, x, audited);
  const int frame = report.frames(), pairs = found.intersecting_pairs();
  const int vertex_pairs = static_cast<int>(found.vertex_pairs.size());
  report.pairs_by_frame.push_back(pairs);
  report.vertex_pairs_by_frame.push_back(vertex_pairs);
  if (pairs > report.worst_pairs) {
    report.worst_pairs = pairs;
    report.worst_frame = frame;
  }
  report.worst_vertex_pairs = std::max(report.worst_vertex_pairs, vertex_pairs);
  report.nonfinite += found.nonfinite;
  report.inside_vertices = std::max(report.inside_vertices, found.inside_vertices);
  report.degenerate_triangles = std::max(report.degenerate_triangles, count_degenerate(rest.surface, x));
  if (found.nonfinite > 0) {  // FCL and distances need finite positions
    if (report.fcl) report.fcl->pairs_by_frame.push_back(0);
    return;
  }
  if (volume) volume->add(x, *report.volume);
  if (report.fcl) add_opinion(rest.surface, x, audited, found, frame, *report.fcl);
  const double reach = std::min(horizon, report.min_gap);
  if (reach > 0)
    report.min_gap = std::min(report.min_gap, pairs > 0 ? 0.0 : smallest_gap(rest.surface, x, audited, reach));
  if (rest.rest_triangle.empty()) return;
  const auto stretches = principal_stretches(rest, x);
  report.min_stretch = std::min(report.min_stretch.value_or(stretches.col(0).minCoeff()), stretches.col(0).minCoeff());
  report.max_stretch = std::max(report.max_stretch.value_or(stretches.col(1).maxCoeff()), stretches.col(1).maxCoeff());
}

// Each cloth of a trajectory is a garment, and so is each component of a mesh.
std::optional<VolumeCheck> volume_check(const CheckRequest& request, const Surface& surface,
                                        const std::vector<int>& first_vertex, CheckReport& report) {
  if (!request.volume) return {};
  report.volume.emplace();
  return VolumeCheck(surface, garments_of_vertices(first_vertex));
}

// The first frame of a trajectory was given, not simulated. Its fans are measured at rest.
std::optional<VolumeCheck> volume_check(const CheckRequest& request, const Surface& surface, const TrajectoryInfo& info,
                                        CheckReport& report) {
  auto volume = volume_check(request, surface, info.cloth_first_vertex, report);
  if (volume) {
    report.volume->first_made = 1;
    report.volume->of_fans = volume->of_fans(info.rest);
  }
  return volume;
}

std::vector<RestTriangle> read_rest(const std::filesystem::path& file, const Triangles& triangles) {
  const Mesh mesh = read_mesh(file);
  if (!same_triangles(mesh.triangles, triangles))
    throw Error("the rest mesh has other triangles than what is checked", file.string(),
                "give the mesh that the cloth was made from, with the same faces in the same order");
  return flattened(mesh.x, triangles);
}

Scene rest_scene(int vertex_count, const Triangles& triangles, std::vector<RestTriangle> rest) {
  Scene scene;
  scene.surface = make_surface(vertex_count, triangles);
  scene.rest_triangle = std::move(rest);
  Cloth cloth;
  cloth.vertex_count = vertex_count;
  cloth.triangle_count = static_cast<int>(triangles.rows());
  scene.cloths.push_back(cloth);
  return scene;
}

// The triangles of a cloth by the numbers of its own vertices, without those that files of other programs join to
// another cloth.
Triangles own_triangles(const TrajectoryInfo& info, std::size_t cloth) {
  const int first = info.cloth_first_vertex[cloth], end = info.cloth_first_vertex[cloth + 1];
  std::vector<int> own;
  for (int t = info.cloth_first_triangle[cloth]; t < info.cloth_first_triangle[cloth + 1]; ++t)
    if (info.triangles.row(t).minCoeff() >= first && info.triangles.row(t).maxCoeff() < end) own.push_back(t);
  return info.triangles(own, Eigen::all).array() - first;
}

// Each cloth by itself: others may lie at the same place.
void warn_of_seams(const TrajectoryInfo& info, CheckReport& report) {
  for (std::size_t c = 0; c < info.cloth_names.size(); ++c) {
    const int vertex = info.cloth_first_vertex[c];
    const Points rest = info.rest.middleRows(vertex, info.cloth_first_vertex[c + 1] - vertex);
    const Welding seams = rest.rows() > 0 ? weldable(rest, own_triangles(info, c)) : Welding();
    if (seams.joined > 0)
      report.warnings.push_back("cloth `" + info.cloth_names[c] + "`: " + unwelded_text(seams, weld_keys_text));
  }
}

void check_trajectory(const CheckRequest& request, CheckReport& report) {
  const TrajectoryReader reader(trajectory_file(request.file));
  const TrajectoryInfo& info = reader.info();
  const Scene scene = rest_scene(static_cast<int>(info.rest.rows()), info.triangles,
                                 request.rest ? read_rest(*request.rest, info.triangles) : info.rest_triangle);
  report.trajectory = true;
  report.closed = reader.closed();
  if (!info.self_audited) report.warnings.push_back("the run left cloth-cloth contact out; it is checked all the same");
  if (!report.closed) report.warnings.push_back("the trajectory was not closed: its writer was stopped or is at work");
  warn_of_seams(info, report);
  Bodies bodies;
  for (const TrajectoryInfo::Body& body : info.obstacles)
    bodies.add(make_surface(body.vertex_count, body.triangles), Points());
  add_body_files(request, bodies, report);
  const auto volume = volume_check(request, scene.surface, info, report);
  int last_cut = -1;
  for (int i = 0; i < reader.frame_count(); ++i) {
    const Frame frame = reader.frame(i);
    for (std::size_t k = 0; k < frame.obstacles.size(); ++k) bodies.points[k] = frame.obstacles[k].cast<double>();
    check_frame(scene, frame.x.cast<double>(), bodies, request.horizon, volume, report);
    if (frame.report.collision.cut_out > 0) last_cut = i;
  }
  if (last_cut >= 0)
    report.warnings.push_back(
        fmt::format("the run had cut triangles out up to frame {}; they are checked all the same", last_cut));
  report.vertices = scene.surface.vertex_count;
  report.triangles = static_cast<int>(info.triangles.rows());
  report.bodies = static_cast<int>(bodies.surfaces.size());
}

void check_mesh(const CheckRequest& request, CheckReport& report) {
  const Mesh mesh = read_mesh(request.file);
  report.warnings.insert(report.warnings.end(), mesh.warnings.begin(), mesh.warnings.end());
  if (const Welding seams = weldable(mesh.x, mesh.triangles); seams.joined > 0)
    report.warnings.push_back(unwelded_text(seams, weld_keys_text));
  for (const std::string& fault : mesh_faults(mesh.x, mesh.triangles)) report.warnings.push_back(fault);
  Bodies bodies;
  add_body_files(request, bodies, report);
  const Scene scene = rest_scene(static_cast<int>(mesh.x.rows()), mesh.triangles,
                                 request.rest ? read_rest(*request.rest, mesh.triangles) : std::vector<RestTriangle>());
  check_frame(scene, mesh.x, bodies, request.horizon, volume_check(request, scene.surface, std::vector<int>(), report),
              report);
  report.vertices = scene.surface.vertex_count;
  report.triangles = static_cast<int>(mesh.triangles.rows());
  report.bodies = static_cast<int>(bodies.surfaces.size());
}

bool is_trajectory(const std::filesystem::path& file_or_folder) {
  const std::string ending = trajectory_file(file_or_folder).extension().string();
  return ending == ".h5" || ending == ".hdf5";
}

}  // namespace

int count_degenerate(const Surface& surface, const Points& x) {
  int count = 0;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    const auto corner = [&](int k) { return row(x, surface.triangles(t, k)); };
    count += corner(0).allFinite() && corner(1).allFinite() && corner(2).allFinite() &&
             is_degenerate(corner(0), corner(1), corner(2));
  }
  return count;
}

CheckReport check(const CheckRequest& request) {
  CheckReport report;
  if (request.audit == "fcl") {
    if (!obstacle_available())
      throw Error("this build has no FCL", "--audit fcl", "install libfcl-dev and configure with -DSELVEDGE_FCL=ON");
    report.fcl.emplace();
  }
  if (is_trajectory(request.file))
    check_trajectory(request, report);
  else
    check_mesh(request, report);
  if (request.against)
    report.measures = measures_against(trajectory_file(request.file), trajectory_file(*request.against));
  return report;
}

bool is_clean(const CheckReport& report) {
  return report.worst_pairs == 0 && report.nonfinite == 0 && report.inside_vertices == 0 &&
         (!report.fcl || report.fcl->beyond_rounding == 0);
}

}  // namespace selvedge

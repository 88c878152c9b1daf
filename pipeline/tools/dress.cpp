#include "pipeline/tools/dress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "collision/audit/audit.hpp"
#include "collision/geometry/counted.hpp"
#include "collision/geometry/distance.hpp"
#include "collision/geometry/error.hpp"
#include "pipeline/bodies/skin_places.hpp"
#include "pipeline/formats/mesh_faults.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/mesh_mtl.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/garments/garment_dressed.hpp"
#include "pipeline/garments/garment_hdf5.hpp"
#include "pipeline/garments/worn_part.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"
#include "pipeline/obstacles/setup_body.hpp"
#include "pipeline/scene/config_scene.hpp"

namespace selvedge {
namespace {

constexpr double far_away = 0.3;  // a larger mean distance from the body is a mistake [m]

// The body with its shape and clip, read as a scene reads them.
Performance read_wearer(const DressRequest& request) {
  std::vector<GivenValue> values{{"model", "--body " + request.body, {request.body}}};
  std::vector<std::string> shape;
  for (const double value : request.shape) shape.push_back(fmt::format("{}", value));
  if (!shape.empty()) values.push_back({"shape", "--shape", shape});
  if (request.pose) values.push_back({"clip", "--pose " + *request.pose, {*request.pose}});
  return read_performance(read_values(table::body_section(), values), {});
}

Vec3 read_rotation(const std::string& text, const std::string& where) {
  Vec3 rotation;
  std::size_t begin = 0;
  for (int k = 0; k < 3; ++k) {
    const std::size_t end = k < 2 ? text.find(',', begin) : text.size();
    if (end == std::string::npos) throw Error("has fewer than three numbers", where, "write JOINT=x,y,z");
    const Quantity value = read_quantity(text.substr(begin, end - begin), Unit::angle);
    if (!value.problem.empty()) throw Error(value.problem, where, "write JOINT=x,y,z, in rad or as `45 deg`");
    rotation[k] = value.value;
    begin = end + 1;
  }
  return rotation;
}

// The pose; without rows it is the zero pose.
BodyPose read_pose(const DressRequest& request, const Performance& who) {
  if (!request.pose && request.rotations.empty()) return {};
  if (const double end = request.pose ? end_of(who.clip) : 0; request.time > end)
    throw Error("is beyond the clip", fmt::format("--time {:g}", request.time),
                fmt::format("it ends at {:.4g} s", end));
  BodyPose pose = pose_at(who, request.time);
  for (const std::string& text : request.rotations) {
    const std::string where = "--rotate " + text;
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) throw Error("is not JOINT=x,y,z", where, "for example left_shoulder=0,0,-45 deg");
    const std::string name = text.substr(0, equals);
    const auto joint = std::ranges::find(who.body.joints, name);
    if (joint == who.body.joints.end())
      throw Error("names the unknown joint `" + name + "`", where,
                  "joints: " + joined(who.body.joints) + suggestion(name, who.body.joints));
    pose.rotations.row(joint - who.body.joints.begin()) = read_rotation(text.substr(equals + 1), where).transpose();
  }
  return pose;
}

Points body_in(const Performance& who, const BodyPose& pose) {
  return pose.rotations.rows() == 0 ? shaped(who.body.skin, who.shape) : posed(who.body, who.shape, pose);
}

double distance_to(const Points& x, const Triangles& triangles, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : triangles.rowwise()) {
    const Vec3 a = row(x, t(0)), b = row(x, t(1)), c = row(x, t(2));
    const double reach = std::sqrt(std::max((b - a).squaredNorm(), (c - a).squaredNorm()));
    if ((p - a).norm() - reach >= least) continue;
    least = std::min(least, std::sqrt(point_triangle(p, a, b, c).squared_distance));
  }
  return least;
}

// `cure`: what would put a mesh on the body that is not on it.
void look_at(const Points& x, const Points& body, const BodyModel& model, const std::function<std::string()>& cure,
             DressReport& report) {
  const Triangles& triangles = report.garment.skin.triangles;
  const Surface cloth = make_surface(static_cast<int>(x.rows()), triangles);
  const Surface surface = closed_surface(model).surface;
  report.components = cloth.component_count;
  Eigen::VectorXd distance(x.rows());
#pragma omp parallel for schedule(static)
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    distance[v] = distance_to(body, model.skin.triangles, x.row(v).transpose());
  report.least_distance = distance.minCoeff();
  report.mean_distance = distance.mean();
  const std::vector<AuditBody> bodies{{&surface, &body}};
  const Audit found = audit(cloth, x, bodies);
  report.inside_vertices = found.inside_vertices;
  report.self_pairs = static_cast<int>(found.self_pairs.size() + found.vertex_pairs.size());
  report.body_pairs = static_cast<int>(found.obstacle_pairs.size());
  if (cloth.nonmanifold_edges > 0)
    report.warnings.push_back(counted(cloth.nonmanifold_edges, "edge") + " of more than two triangles");
  report.on_body = !worn_part(of_triangles(x, triangles), body).places.empty();
  if (!report.on_body)
    report.warnings.push_back("is not worn: hardly a vertex lies on the body; " + cure());
  else if (report.mean_distance > far_away)
    report.warnings.push_back(
        fmt::format("lies {:.2g} m from the body on average: are unit, pose and body right?", report.mean_distance));
}

std::string frame_options(const MeshFrame& frame) {
  return "--unit " + frame.unit + " --up " + (frame.up == Up::y ? "y" : "z");
}

std::string frame_cure(const Mesh& mesh, const Points& body, const Triangles& body_triangles) {
  const std::optional<MeshFrame> frame = clear_frame(fitting_frames(mesh.x, mesh.triangles, body, body_triangles));
  return frame ? frame_options(*frame) + " would put it there" : "are unit, pose and body right?";
}

// How the mesh is meant: as the request says, or as it lies on the body.
MeshFrame frame_of(const DressRequest& request, const Mesh& mesh, const Points& body, const Triangles& body_triangles,
                   std::string& reason) {
  MeshFrame frame{request.unit.value_or("m"), request.up.value_or(Up::y)};
  if (request.unit && request.up) return frame;
  const std::vector<FrameFit> fits =
      fitting_frames(mesh.x, mesh.triangles, body, body_triangles, request.unit, request.up);
  if (fits.empty()) {
    reason = "assumed: in no unit and with no axis up does the mesh lie on the body";
    return frame;
  }
  const std::optional<MeshFrame> clear = clear_frame(fits);
  if (!clear)
    throw Error(fmt::format("would lie on the body about equally well in {} and in {}", frame_text(fits[0].frame),
                            frame_text(fits[1].frame)),
                request.mesh.string(),
                fmt::format("say which: {} or {}", frame_options(fits[0].frame), frame_options(fits[1].frame)));
  reason = fmt::format("guessed: so it lies on the body, {}; {} says the same",
                       fits.size() == 1 ? "and in any other way it does not, or crosses it"
                                        : "and nearer than in " + frame_text(fits[1].frame),
                       frame_options(*clear));
  return *clear;
}

// Joins the pieces if that is asked for, else counts what it would join.
void weld_pieces(const DressRequest& request, Mesh& mesh, DressReport& report) {
  if (request.weld) {
    report.welded = weld(mesh, request.mesh.string(), request.weld_within).joined;
    return;
  }
  const Welding seams = weldable(mesh.x, mesh.triangles);
  report.weldable = seams.joined;
  if (seams.joined > 0) report.warnings.push_back(unwelded_text(seams, "--weld"));
}

}  // namespace

DressReport dress(const DressRequest& request) {
  h5::check_out_name(request.out, "garments");
  Mesh mesh = read_mesh(request.mesh);
  read_materials(mesh);
  const Performance who = read_wearer(request);
  DressReport report;
  const BodyPose stands = read_pose(request, who);
  const Mesh as_read = mesh;
  const Points worn_by = body_in(who, stands);
  report.frame = frame_of(request, as_read, worn_by, who.body.skin.triangles, report.frame_reason);
  mesh.x = in_metres(as_read.x, report.frame);
  weld_pieces(request, mesh, report);
  for (const std::string& fault : mesh_faults(mesh.x, mesh.triangles)) report.warnings.push_back(fault);
  report.warnings.insert(report.warnings.begin(), mesh.warnings.begin(), mesh.warnings.end());
  report.warnings.insert(report.warnings.end(), who.warnings.begin(), who.warnings.end());
  if (request.pose && !who.clip.poses.empty() && request.time > end_of(who.clip))
    report.warnings.push_back(fmt::format("{} ends at {:.4g} s, before {:.4g} s: its last pose is taken", *request.pose,
                                          end_of(who.clip), request.time));
  const Dressing how{who.shape, stands, request.fit == "tight" ? Fit::tight : Fit::loose, request.pins};
  DressedMesh made = dressed(mesh, who.body, how);
  report.pinned = std::move(made.pinned);
  Garment& garment = report.garment = std::move(made.garment);
  garment.name = request.mesh.stem().string();
  report.reposed = (rest_shape(garment, who.body, who.shape) - mesh.x).rowwise().norm().maxCoeff();
  look_at(
      mesh.x, worn_by, who.body, [&] { return frame_cure(as_read, worn_by, who.body.skin.triangles); }, report);
  write_garment(request.out, garment);
  return report;
}

bool is_clean(const DressReport& report) {
  return report.on_body && report.self_pairs + report.body_pairs + report.inside_vertices == 0;
}

}  // namespace selvedge

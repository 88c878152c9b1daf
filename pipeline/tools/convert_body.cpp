#include "pipeline/tools/convert_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/error.hpp"
#include "collision/geometry/surface.hpp"
#include "pipeline/bodies/body_hdf5.hpp"
#include "pipeline/bodies/body_jointed.hpp"
#include "pipeline/bodies/body_makehuman.hpp"
#include "pipeline/bodies/body_outward.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/skin_places.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/config/config_units.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"
#include "pipeline/host/file_formats.hpp"
#include "pipeline/host/label_lines.hpp"
#include "pipeline/host/lower_extension.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/motions/rig_gltf.hpp"
#include "pipeline/motions/t_pose.hpp"

namespace selvedge {
namespace {

constexpr double degree = std::numbers::pi / 180;

// A body whose file says itself which axis is up.
void refuse_axis(const BodyRequest& request, const std::string& kind) {
  if (request.up == Up::z) throw Error("is given for " + kind + ", in which y is up", "--up z", "leave it out");
}

BodyModel read_mesh_body(const BodyRequest& request) {
  const double metres = metres_per_unit(request.unit);
  const bool rigged = !request.skeleton.empty() || !request.weights.empty();
  if (!request.joints.empty() && rigged)
    throw Error("gets its joints twice", request.file.string(), "give --joints, or --skeleton and --weights");
  if (!request.joints.empty()) return read_jointed(request.file, request.joints, metres, request.meshes);
  if (request.skeleton.empty() || request.weights.empty())
    throw Error("is a mesh without a skeleton or weights", request.file.string(),
                "give --skeleton and --weights, or --joints");
  return read_makehuman(request.file, request.skeleton, request.weights, metres, request.meshes);
}

BodyModel read(const BodyRequest& request, BodyReport& report) {
  const std::string extension = lower_extension(request.file);
  if (is_gltf(request.file)) {
    if (request.unit != "m")
      throw Error("is given for glTF, which is in metres", "--unit " + request.unit, "leave it out");
    refuse_axis(request, "glTF");
    GltfRig rig = read_gltf_rig(request.file, request.meshes);
    for (const GltfAnimation& animation : rig.scene.animations) report.animations.push_back(animation.name);
    report.warnings = rig.scene.mesh.warnings;
    return std::move(rig.body);
  }
  if (extension == ".npz") {
    if (request.meshes.any())
      throw Error("has no meshes by name", request.file.string(), "leave --mesh and --without out");
    refuse_axis(request, "a model of the SMPL family");
    return read_smpl(request.file);
  }
  if (extension != ".obj" && extension != ".ply")
    throw Error("is neither a mesh (.obj, .ply), a model of the SMPL family (.npz) nor glTF (.glb, .gltf)",
                request.file.string(),
                export_cure(request.file, ".glb", "write other bodies in HDF5 yourself, see docs/bodies.md"));
  BodyModel body = read_mesh_body(request);
  turn_y_up(request.up, body);
  return body;
}

}  // namespace

BodyReport convert_body(const BodyRequest& request) {
  h5::check_out_name(request.out, "bodies");
  BodyReport report;
  BodyModel body = read(request, report);
  turn_outward(request.file.string(), body, report.warnings);
  warn_of_axis(request.file.string(), body, report.warnings);
  const Points& rest = body.skin.rest;
  const Points joints = joint_positions(body, {});
  report.out = request.out;
  report.vertices = static_cast<int>(rest.rows());
  report.triangles = static_cast<int>(body.skin.triangles.rows());
  report.joints = static_cast<int>(body.joints.size());
  report.shapes = static_cast<int>(body.skin.shape_directions.cols());
  report.closed = is_closed(closed_surface(body).surface);
  report.height = rest.col(1).maxCoeff() - rest.col(1).minCoeff();
  const std::vector<int> found = smpl_joints_among(body.joints);
  if (const auto missing = std::ranges::find(found, -1); missing != found.end()) {
    report.lacks = smpl_joint_names(smpl::joints)[static_cast<std::size_t>(missing - found.begin())];
  } else {
    report.arms_off = arms_off_t_pose(smpl_joints(body, joints));
    report.t_pose = !t_pose(body, joints);
  }
  for (const auto& [name, vertices] : body.meshes) report.meshes.push_back(name);
  report.crossings = own_crossings(body, {});
  write_body(request.out, body);
  return report;
}

std::string body_json(const BodyReport& r) {
  Json own = Json::array();
  for (const OwnCrossings::Between& one : r.crossings.between)
    own.push_back({{"mesh", one.a}, {"with", one.b}, {"pairs", one.pairs}});
  const Json json = {{"body", r.out.string()},     {"vertices", r.vertices},
                     {"triangles", r.triangles},   {"closed", r.closed},
                     {"joints", r.joints},         {"shapes", r.shapes},
                     {"height", r.height},         {"arms_off", r.arms_off},
                     {"t_pose", r.t_pose},         {"lacks", r.lacks},
                     {"animations", r.animations}, {"meshes", r.meshes},
                     {"own_pairs", own},           {"own_pairs_counted", !r.crossings.too_many},
                     {"warnings", r.warnings}};
  return json_text(json);
}

std::string body_text(const BodyReport& r) {
  LabelLines add{20};
  add("surface", fmt::format("{}, {}, {}", counted(r.vertices, "vertex", "vertices"), counted(r.triangles, "triangle"),
                             r.closed ? "closed" : "not closed"));
  add("joints", fmt::format("{}, {}", r.joints, counted(r.shapes, "shape")));
  add("height", fmt::format("{:.3f} m", r.height));
  if (r.lacks.empty())
    add("zero pose", fmt::format("arms {:.0f} degrees from SMPL's, {}", r.arms_off / degree,
                                 r.t_pose ? "taken as the same" : "clips are carried over"));
  else
    add("zero pose", fmt::format("no joint `{}`: only its own animations move it", r.lacks));
  if (!r.animations.empty()) add("animations", fmt::format("{}", fmt::join(r.animations, ", ")));
  if (r.meshes.size() > 1) add("meshes", fmt::format("{}", fmt::join(r.meshes, ", ")));
  const std::string crossings = crossings_text(r.crossings);
  add("crosses itself", crossings.empty() ? "nowhere in its zero pose" : "in its zero pose in " + crossings);
  for (const std::string& warning : r.warnings) add("warning", warning);
  add("body", r.out.string());
  return add.text;
}

}  // namespace selvedge

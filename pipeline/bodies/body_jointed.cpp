#include "pipeline/bodies/body_jointed.hpp"

#include <fmt/format.h>

#include "collision/exact/inside.hpp"
#include "collision/geometry/welded_surface.hpp"
#include "pipeline/bodies/body_part.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/bone_weights.hpp"
#include "pipeline/bodies/joint_regressor.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/config/config_tables.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/seam_places.hpp"

namespace selvedge {
namespace {

using namespace table;

bool is_right(const std::string& joint) { return joint.starts_with("right_"); }

const Section& joints_section() {
  static const Section table = [] {
    Section all{"joints", "SMPL's joints; of the right side those that are not where the left ones are."};
    for (const std::string& name : smpl_joint_names(smpl::joints)) {
      const Key key = vector(name, Unit::length, "", is_right(name) ? "left out: the left one, mirrored" : "");
      all.keys.push_back(is_right(name) ? key : needed(key));
    }
    return all;
  }();
  return table;
}

const Section& file_section() {
  static const Section table{"joints of a body",
                             "The whole file.",
                             {text("description", "for people"),
                              needed(section(joints_section(), "", "where the joints are, in the pose of the mesh"))}};
  return table;
}

// A joint's entry; for a missing right joint that of the left one.
const Config& entry_of(const Config& joints, const std::string& name) {
  const Config& own = joints[name];
  return own.given || !is_right(name) ? own : joints["left" + name.substr(5)];
}

Points places(const Config& joints, const std::vector<std::string>& names) {
  const double middle = joints[names[0]].vector()[0];
  Points x(static_cast<Eigen::Index>(names.size()), 3);
  for (std::size_t j = 0; j < names.size(); ++j) {
    Vec3 place = entry_of(joints, names[j]).vector();
    if (is_right(names[j]) && !joints[names[j]].given) place[0] = 2 * middle - place[0];
    x.row(static_cast<Eigen::Index>(j)) = place.transpose();
  }
  return x;
}

void check_inside(const BodyModel& body, const Surface& surface, const Points& joints, const Config& given) {
  if (!is_closed(surface)) return;
  const std::vector<char> within = inside(surface, body.skin.rest, joints);
  for (std::size_t j = 0; j < within.size(); ++j) {
    if (within[j]) continue;
    const Vec3 low = body.skin.rest.colwise().minCoeff(), high = body.skin.rest.colwise().maxCoeff();
    entry_of(given, body.joints[j])
        .fail("lies outside the body" + std::string(is_right(body.joints[j]) ? ", mirrored or not" : ""),
              fmt::format("give its place in the pose of the mesh, which reaches from [{:.3f}, {:.3f}, {:.3f}] to "
                          "[{:.3f}, {:.3f}, {:.3f}] m; is --unit right?",
                          low[0], low[1], low[2], high[0], high[1], high[2]));
  }
}

// Computes weights on the surface with the seams of its file closed, so that vertices at one place follow the same
// joint and heat spreads over seams.
void set_weights(const Points& joints, const Config& given, BodyModel& body) {
  const auto n = static_cast<int>(body.skin.rest.rows());
  Surface surface = make_surface(n, body.skin.triangles);
  std::optional<WeldedSurface> welded = welded_surface(surface, seam_places({&body.skin.rest, 1}, body.skin.triangles));
  if (welded) surface = std::move(welded->surface);
  check_inside(body, surface, joints, given);
  body.skin.weights = bone_weights(surface, body.skin.rest, joints, body.parents);
  if (!welded) return;
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < n; ++v) entries.emplace_back(v, welded->joined[v], 1);
  body.skin.weights = SkinWeights(from_entries(n, n, entries) * body.skin.weights);
}

}  // namespace

BodyModel read_jointed(const std::filesystem::path& mesh_file, const std::filesystem::path& joints_file, double metres,
                       const NameChoice& choice) {
  Mesh mesh = read_mesh(mesh_file);
  mesh.x *= metres;
  const BodyPart part = body_part(mesh, mesh_file, choice);
  const Config file = read_config(joints_file, file_section());
  BodyModel body = body_without_rig(mesh, part, mesh_file);
  const Points joints = places(file["joints"], body.joints);
  set_weights(joints, file["joints"], body);
  std::vector<std::optional<Vec3>> given;
  for (int j = 0; j < joints.rows(); ++j) given.emplace_back(row(joints, j));
  body.regressor = joint_regressor(body, given, {mesh_file.string(), joints_file.string()});
  check_body(body, mesh_file.string());
  return body;
}

}  // namespace selvedge

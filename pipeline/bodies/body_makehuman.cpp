#include "pipeline/bodies/body_makehuman.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "collision/geometry/surface.hpp"
#include "pipeline/bodies/body_part.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/joint_regressor.hpp"
#include "pipeline/bodies/makehuman_rig.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/formats/mesh_io.hpp"

namespace selvedge {
namespace {

namespace fs = std::filesystem;

constexpr double most_torn = 0.01;  // of the edges may join vertices of distant joints; a renumbered base mesh has 0.05

// The bones of a joint of SMPL, which is at the mean of their heads. For joints in pairs those of that side.
std::vector<std::string> bones_of(const std::string& joint) {
  static const std::map<std::string, std::vector<std::string>> table = {
      {"pelvis", {"root"}},
      {"spine1", {"spine03"}},
      {"spine2", {"spine02"}},
      {"spine3", {"spine01"}},
      {"neck", {"neck01"}},
      {"head", {"head"}},
      {"collar", {"clavicle"}},
      {"shoulder", {"upperarm01"}},
      {"elbow", {"lowerarm01"}},
      {"wrist", {"wrist"}},
      {"hand", {"finger2-1", "finger3-1", "finger4-1", "finger5-1"}},
      {"hip", {"upperleg01"}},
      {"knee", {"lowerleg01"}},
      {"ankle", {"foot"}},
      {"foot", {"toe1-1", "toe2-1", "toe3-1", "toe4-1", "toe5-1"}}};
  const std::string part = joint.substr(joint.find('_') + 1);
  std::vector<std::string> bones = table.at(part);
  for (std::string& bone : bones)
    if (part != joint) bone += joint.starts_with("left") ? ".L" : ".R";
  return bones;
}

// The bones whose heads give a joint's place. The root's own head is behind the body; the spine begins in the middle of
// the pelvis.
std::vector<std::string> places_of(const std::string& joint) {
  return joint == "pelvis" ? std::vector<std::string>{"spine05"} : bones_of(joint);
}

struct Rig {
  fs::path file;
  std::vector<RigBone> bones;

  int find(const std::string& name, const std::string& joint) const {
    const auto at = std::find_if(bones.begin(), bones.end(), [&](const RigBone& bone) { return bone.name == name; });
    if (at == bones.end())
      throw Error("has no bone `" + name + "`, which SMPL's joint " + joint + " is made of", file.string(),
                  "give MakeHuman's default skeleton, or convert the body as docs/bodies.md says");
    return static_cast<int>(at - bones.begin());
  }

  // The joint of each bone.
  std::vector<int> joints() const {
    std::vector<int> joint(bones.size(), -1);
    const std::vector<std::string> names = smpl_joint_names(smpl::joints);
    for (std::size_t j = 0; j < names.size(); ++j)
      for (const std::string& bone : bones_of(names[j])) joint[find(bone, names[j])] = static_cast<int>(j);
    for (std::size_t b = 0; b < bones.size(); ++b)
      for (int at = static_cast<int>(b); joint[b] < 0; at = bones[at].parent) {
        if (at < 0)
          throw Error("bone `" + bones[b].name + "` hangs on none that is known", file.string(),
                      "let it hang, by its parents, on `root`");
        joint[b] = joint[at];
      }
    return joint;
  }
};

SkinWeights folded(const std::vector<RigWeight>& weights, const std::vector<int>& joints, const BodyPart& part,
                   const fs::path& file) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const RigWeight& one : weights) {
    const auto vertex = static_cast<std::size_t>(one.vertex);
    if (one.weight > 0 && vertex < part.row_of.size() && part.row_of[vertex] >= 0)
      entries.emplace_back(part.row_of[vertex], joints[one.bone], one.weight);
  }
  SkinWeights sums = from_entries(std::ssize(part.vertices), smpl::joints, entries);
  for (Eigen::Index v = 0; v < sums.rows(); ++v) {
    const double sum = sums.row(v).sum();
    if (sum == 0)
      throw Error(fmt::format("has no weight for vertex {} of the body", part.vertices[v]), file.string(),
                  "give the weights of this mesh; vertices count from 0");
    sums.row(v) /= sum;
  }
  return sums;
}

bool near_in_tree(int a, int b) {
  const auto above = [](int joint) { return smpl_joint_parents()[joint]; };
  const auto within_one = [&](int p, int q) { return p == q || above(p) == q || above(q) == p; };
  return within_one(a, b) || (above(a) >= 0 && within_one(above(a), b)) || (above(b) >= 0 && within_one(a, above(b)));
}

// Throws Error if neighbours on the body follow joints that are not neighbours. Programs that leave out the helpers
// often renumber vertices, and weights then belong to other vertices.
void check_order(const Surface& surface, const SkinWeights& weights, const fs::path& mesh, const fs::path& file) {
  Eigen::Index torn = 0;
  for (const auto& edge : surface.edges.rowwise()) {
    bool together = false;
    for (SkinWeights::InnerIterator a(weights, edge[0]); a && !together; ++a)
      for (SkinWeights::InnerIterator b(weights, edge[1]); b && !together; ++b)
        together = near_in_tree(static_cast<int>(a.col()), static_cast<int>(b.col()));
    torn += !together;
  }
  const double share = static_cast<double>(torn) / static_cast<double>(surface.edges.rows());
  if (share > most_torn)
    throw Error(
        fmt::format("has its vertices in another order than the weights: the ends of {:.0f} % of its edges hang "
                    "on joints far apart",
                    100 * share),
        mesh.string(), "give the base mesh that " + file.filename().string() + " was made for (base.obj)");
}

// The mean of the reference vertices of the joint's bones; nothing if the mesh lacks one.
std::optional<Vec3> reference(const Rig& rig, const std::string& joint, const Points& mesh) {
  Vec3 sum = Vec3::Zero();
  const std::vector<std::string> places = places_of(joint);
  for (const std::string& bone : places) {
    const std::vector<int>& head = rig.bones[rig.find(bone, joint)].head;
    Vec3 middle = Vec3::Zero();
    for (const int v : head) {
      if (v >= mesh.rows()) return {};
      middle += row(mesh, v) / static_cast<double>(head.size());
    }
    sum += middle / static_cast<double>(places.size());
  }
  return sum;
}

}  // namespace

BodyModel read_makehuman(const fs::path& mesh_file, const fs::path& skeleton, const fs::path& weights_file,
                         double metres, const NameChoice& choice) {
  Mesh mesh = read_mesh(mesh_file);
  mesh.x *= metres;
  const Rig rig{skeleton, read_rig_bones(skeleton)};
  const BodyPart part = body_part(mesh, mesh_file, choice);
  BodyModel body = body_without_rig(mesh, part, mesh_file);
  body.skin.weights = folded(read_rig_weights(weights_file, rig.bones), rig.joints(), part, weights_file);
  check_order(make_surface(static_cast<int>(body.skin.rest.rows()), part.triangles), body.skin.weights, mesh_file,
              weights_file);
  std::vector<std::optional<Vec3>> places;
  for (const std::string& joint : body.joints) places.push_back(reference(rig, joint, mesh.x));
  body.regressor = joint_regressor(body, places, {weights_file.string(), skeleton.string()});
  check_body(body, mesh_file.string());
  return body;
}

}  // namespace selvedge

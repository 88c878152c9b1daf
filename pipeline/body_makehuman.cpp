#include "pipeline/body_makehuman.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "collision/error.hpp"
#include "collision/surface.hpp"
#include "pipeline/body_smpl.hpp"
#include "pipeline/joint_regressor.hpp"
#include "pipeline/makehuman_rig.hpp"
#include "pipeline/mesh_io.hpp"
#include "pipeline/smpl_joints.hpp"

namespace selvedge {
namespace {

namespace fs = std::filesystem;

constexpr double most_torn = 0.01;      // of the edges; a renumbered base mesh has 0.05
constexpr double farthest_miss = 1e-4;  // of a joint from its reference [m]

// The bones that a joint of SMPL is made of, where it begins; of joints in pairs those of a side.
std::vector<std::string> bones_of(const std::string& joint) {
  static const std::vector<std::pair<std::string, std::vector<std::string>>> table = {
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
  std::vector<std::string> bones =
      std::find_if(table.begin(), table.end(), [&](const auto& entry) { return entry.first == part; })->second;
  for (std::string& bone : bones)
    if (part != joint) bone += joint.starts_with("left") ? ".L" : ".R";
  return bones;
}

// The root's own head is behind the body; where the spine begins is the middle of the pelvis.
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
      for (const std::string& bone : bones_of(names[j]))
        joint[static_cast<std::size_t>(find(bone, names[j]))] = static_cast<int>(j);
    for (std::size_t b = 0; b < bones.size(); ++b)
      for (int at = static_cast<int>(b); joint[b] < 0; at = bones[static_cast<std::size_t>(at)].parent) {
        if (at < 0)
          throw Error("bone `" + bones[b].name + "` hangs on none that is known", file.string(),
                      "let it hang, by its parents, on `root`");
        joint[b] = joint[static_cast<std::size_t>(at)];
      }
    return joint;
  }
};

// The body in the mesh: rows of the mesh, and its triangles by rows of the body.
struct Part {
  std::vector<int> vertices, row_of;  // row_of: -1 for what is not of the body
  Triangles triangles;
};

Part body_of(const Mesh& mesh, const fs::path& file) {
  std::vector<char> of_body(static_cast<std::size_t>(mesh.x.rows()), 1);
  for (const auto& [group, vertices] : mesh.groups) {
    if (group != "body") continue;
    std::fill(of_body.begin(), of_body.end(), 0);
    for (const int v : vertices) of_body[static_cast<std::size_t>(v)] = 1;
  }
  std::vector<char> used(of_body.size(), 0);
  std::vector<std::array<int, 3>> triangles;
  for (const auto& t : mesh.triangles.rowwise()) {
    const auto inside = [&](int k) { return of_body[static_cast<std::size_t>(t[k])] != 0; };
    if (!inside(0) || !inside(1) || !inside(2)) continue;
    triangles.push_back({t[0], t[1], t[2]});
    for (int k = 0; k < 3; ++k) used[static_cast<std::size_t>(t[k])] = 1;
  }
  if (triangles.empty()) throw Error("has no faces of a body", file.string(), "its group `body` must have them");
  Part part{{}, std::vector<int>(used.size(), -1), Triangles(static_cast<Eigen::Index>(triangles.size()), 3)};
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    part.row_of[v] = static_cast<int>(part.vertices.size());
    part.vertices.push_back(static_cast<int>(v));
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      part.triangles(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(k)) =
          part.row_of[static_cast<std::size_t>(triangles[t][k])];
  return part;
}

SkinWeights folded(const std::vector<RigWeight>& weights, const std::vector<int>& joints, const Part& part,
                   const fs::path& file) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const RigWeight& one : weights) {
    const auto vertex = static_cast<std::size_t>(one.vertex);
    if (one.weight > 0 && vertex < part.row_of.size() && part.row_of[vertex] >= 0)
      entries.emplace_back(part.row_of[vertex], joints[static_cast<std::size_t>(one.bone)], one.weight);
  }
  SkinWeights sums(static_cast<Eigen::Index>(part.vertices.size()), smpl::joints);
  sums.setFromTriplets(entries.begin(), entries.end());
  for (Eigen::Index v = 0; v < sums.rows(); ++v) {
    const double sum = sums.row(v).sum();
    if (sum == 0)
      throw Error(fmt::format("has no weight for vertex {} of the body", part.vertices[static_cast<std::size_t>(v)]),
                  file.string(), "give the weights of this mesh; vertices count from 0");
    sums.row(v) /= sum;
  }
  return sums;
}

bool near_in_tree(int a, int b) {
  const auto above = [](int joint) { return smpl_joint_parents()[static_cast<std::size_t>(joint)]; };
  const auto within_one = [&](int p, int q) { return p == q || above(p) == q || above(q) == p; };
  return within_one(a, b) || (above(a) >= 0 && within_one(above(a), b)) || (above(b) >= 0 && within_one(a, above(b)));
}

// Neighbours on a body hang on joints that are neighbours too. Programs that leave the helpers out often number the
// vertices anew, and the weights are then those of vertices somewhere else.
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

// What a vertex has of a joint times what it has of the joint's parent, or of its children for the root: what bends
// where the joint is.
Eigen::VectorXd bends_at(const Eigen::MatrixXd& weights, int joint) {
  const std::vector<int>& parents = smpl_joint_parents();
  Eigen::VectorXd others = Eigen::VectorXd::Zero(weights.rows());
  for (int other = 0; other < smpl::joints; ++other)
    if (other == parents[static_cast<std::size_t>(joint)] ||
        (joint == 0 && parents[static_cast<std::size_t>(other)] == 0))
      others += weights.col(other);
  return weights.col(joint).cwiseProduct(others);
}

// Where the middles of the bones' reference vertices are; nothing if the mesh lacks one.
std::optional<Vec3> reference(const Rig& rig, const std::string& joint, const Points& mesh) {
  Vec3 sum = Vec3::Zero();
  const std::vector<std::string> places = places_of(joint);
  for (const std::string& bone : places) {
    const std::vector<int>& head = rig.bones[static_cast<std::size_t>(rig.find(bone, joint))].head;
    Vec3 middle = Vec3::Zero();
    for (const int v : head) {
      if (v >= mesh.rows()) return {};
      middle += row(mesh, v) / static_cast<double>(head.size());
    }
    sum += middle / static_cast<double>(places.size());
  }
  return sum;
}

SkinWeights make_regressor(const Rig& rig, const Points& mesh, const SkinnedSurface& skin, const fs::path& file) {
  const std::vector<std::string> names = smpl_joint_names(smpl::joints);
  const Eigen::MatrixXd weights = skin.weights;
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < smpl::joints; ++j) {
    const std::string& name = names[static_cast<std::size_t>(j)];
    const Eigen::VectorXd bends = bends_at(weights, j);
    std::vector<int> vertices;
    for (int v = 0; v < bends.size(); ++v)
      if (bends[v] > 0) vertices.push_back(v);
    if (vertices.empty())
      throw Error("has no vertex that moves with both the joint " + name + " and its parent", file.string(),
                  "give weights that pass smoothly from bone to bone");
    Eigen::VectorXd share(static_cast<Eigen::Index>(vertices.size()));
    for (std::size_t k = 0; k < vertices.size(); ++k) share[static_cast<Eigen::Index>(k)] = bends[vertices[k]];
    share /= share.sum();
    const std::optional<Vec3> place = reference(rig, name, mesh);
    if (place) meet(skin.rest, vertices, *place, share);
    Vec3 mean = Vec3::Zero();
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      mean += share[static_cast<Eigen::Index>(k)] * row(skin.rest, vertices[k]);
      if (share[static_cast<Eigen::Index>(k)] > 0)
        entries.emplace_back(j, vertices[k], share[static_cast<Eigen::Index>(k)]);
    }
    if (place && !((mean - *place).norm() < farthest_miss))
      throw Error("puts the joint " + name + " outside the vertices that move with it and its parent",
                  rig.file.string(), "give mesh, skeleton and weights of one body");
  }
  SkinWeights regressor(smpl::joints, skin.rest.rows());
  regressor.setFromTriplets(entries.begin(), entries.end());
  return regressor;
}

}  // namespace

BodyModel read_makehuman(const fs::path& mesh_file, const fs::path& skeleton, const fs::path& weights_file,
                         double metres) {
  Mesh mesh = read_mesh(mesh_file);
  mesh.x *= metres;
  const Rig rig{skeleton, read_rig_bones(skeleton)};
  const Part part = body_of(mesh, mesh_file);
  BodyModel body;
  body.name = mesh_file.stem().string();
  body.joints = smpl_joint_names(smpl::joints);
  body.parents = smpl_joint_parents();
  body.skin.rest = mesh.x(part.vertices, Eigen::all);
  body.skin.triangles = part.triangles;
  body.skin.weights = folded(read_rig_weights(weights_file, rig.bones), rig.joints(), part, weights_file);
  body.skin.shape_directions.resize(body.skin.rest.size(), 0);
  check_order(make_surface(static_cast<int>(body.skin.rest.rows()), part.triangles), body.skin.weights, mesh_file,
              weights_file);
  body.regressor = make_regressor(rig, mesh.x, body.skin, weights_file);
  check_body(body, mesh_file.string());
  return body;
}

}  // namespace selvedge

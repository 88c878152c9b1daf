#include "pipeline/motions/rig_gltf.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/geometry/error.hpp"
#include "collision/geometry/factorisations.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/joint_regressor.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/config/config.hpp"
#include "pipeline/motions/clip_bvh.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {
namespace {

using Eigen::Matrix4d;

Matrix4d local_transform(const GltfNode& node) {
  Matrix4d m = Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = node.rotation.toRotationMatrix() * node.scale.asDiagonal();
  m.topRightCorner<3, 1>() = node.translation;
  return m;
}

std::vector<Matrix4d> global_transforms(const std::vector<GltfNode>& nodes) {
  std::vector<Matrix4d> all;
  for (const GltfNode& node : nodes) {
    const Matrix4d local = local_transform(node);
    all.push_back(node.parent < 0 ? local : Matrix4d(all[node.parent] * local));
  }
  return all;
}

// The scale of a similarity transform, below 0 if it mirrors; 0 if it is none.
double size_of(const Matrix4d& m) {
  const Mat3 linear = m.topLeftCorner<3, 3>();
  const double size = std::cbrt(linear.determinant());
  if (size == 0 || !std::isfinite(size)) return 0;
  return (linear.transpose() * linear / (size * size)).isIdentity(1e-3) ? size : 0;
}

// The rotation of a polar decomposition; `m` keeps orientation.
Mat3 nearest_rotation(const Mat3& m) {
  const Spectrum3 stretch = symmetric_spectrum3(m.transpose() * m);  // of its squares
  return m * stretch.vectors * stretch.values.cwiseSqrt().cwiseInverse().asDiagonal() * stretch.vectors.transpose();
}

// The parent of each joint of a skin among these joints; other nodes between are skipped.
std::vector<int> parents_among(const GltfScene& scene) {
  std::vector<int> joint_of(scene.nodes.size(), -1), parents;
  for (std::size_t j = 0; j < scene.joints.size(); ++j) joint_of[scene.joints[j]] = static_cast<int>(j);
  for (const int joint : scene.joints) {
    int node = scene.nodes[joint].parent;
    while (node >= 0 && joint_of[node] < 0) node = scene.nodes[node].parent;
    parents.push_back(node < 0 ? -1 : joint_of[node]);
  }
  return parents;
}

// The skin's joints that the body has, parents first: from the first joint with weights or several children on.
std::vector<int> kept_joints(const GltfScene& scene, const std::vector<int>& parents, const std::string& file) {
  const auto children = [&](int joint) {
    std::vector<int> found;
    for (std::size_t j = 0; j < parents.size(); ++j)
      if (parents[j] == joint) found.push_back(static_cast<int>(j));
    return found;
  };
  const Eigen::VectorXd used = scene.weights.transpose() * Eigen::VectorXd::Ones(scene.weights.rows());
  std::vector<int> roots = children(-1);
  if (roots.size() != 1)
    throw Error(fmt::format("has {} roots", roots.size()), file + ": skin, joints",
                "give the armature one root joint, or choose meshes that follow one armature");
  while (used[roots[0]] == 0 && children(roots[0]).size() == 1) roots = children(roots[0]);
  std::vector<int> order = roots;
  for (std::size_t k = 0; k < order.size(); ++k)
    for (const int child : children(order[k])) order.push_back(child);
  return order;
}

// SMPL's names if the rig's naming is known, else its own; all names are unique.
std::vector<std::string> joint_names(const std::vector<std::string>& names, const std::vector<int>& parents,
                                     const std::string& file) {
  std::vector<std::string> all = names;
  std::vector<char> is_smpl(names.size(), 0);
  BvhFile rig{file, {}, 1, {}};
  for (std::size_t j = 0; j < names.size(); ++j) rig.joints.push_back({names[j], parents[j], Vec3::Zero(), {}, 0});
  try {
    const std::vector<int> found = matched_joints(rig, {});
    const std::vector<std::string> smpl_names = smpl_joint_names(smpl::joints);
    for (std::size_t k = 0; k < found.size(); ++k)
      if (found[k] >= 0 && !is_smpl[found[k]]) {
        all[found[k]] = smpl_names[k];
        is_smpl[found[k]] = 1;
      }
  } catch (const Error&) {  // not a human rig: keeps its own names
  }
  for (std::size_t j = 0; j < all.size(); ++j)
    while (!is_smpl[j] && std::ranges::count(all, all[j]) > 1) all[j] += "_";
  return all;
}

// The three or four numbers of a track at a time.
Eigen::VectorXd value_at(const GltfTrack& track, double time) {
  const bool cubic = track.interpolation == GltfInterpolation::cubic;
  const Eigen::Index last = track.times.size() - 1;
  const auto value = [&](Eigen::Index k) -> Eigen::VectorXd {
    return track.values.row(cubic ? 3 * k + 1 : k).transpose();
  };
  if (time <= track.times[0]) return value(0);
  if (time >= track.times[last]) return value(last);
  const Eigen::Index k = std::upper_bound(track.times.data(), track.times.data() + last, time) - track.times.data() - 1;
  const double length = track.times[k + 1] - track.times[k], s = (time - track.times[k]) / length;
  if (track.interpolation == GltfInterpolation::step) return value(k);
  if (cubic) {
    const Eigen::VectorXd leaves = length * track.values.row(3 * k + 2).transpose(),
                          comes = length * track.values.row(3 * k + 3).transpose();
    const double s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * value(k) + (s3 - 2 * s2 + s) * leaves + (3 * s2 - 2 * s3) * value(k + 1) +
           (s3 - s2) * comes;
  }
  if (track.path != GltfPath::rotation) return (1 - s) * value(k) + s * value(k + 1);
  const Eigen::Quaterniond a(Eigen::Vector4d(value(k)).normalized()), b(Eigen::Vector4d(value(k + 1)).normalized());
  return a.slerp(s, b).coeffs();
}

std::vector<GltfNode> nodes_at(const GltfRig& rig, const GltfAnimation& animation, double time) {
  std::vector<GltfNode> nodes = rig.scene.nodes;
  for (const GltfTrack& track : animation.tracks) {
    GltfNode& node = nodes[track.node];
    const Eigen::VectorXd value = value_at(track, time);
    if (track.path == GltfPath::rotation)
      node.rotation = Eigen::Quaterniond(Eigen::Vector4d(value)).normalized();
    else
      (track.path == GltfPath::scale ? node.scale : node.translation) = value;
  }
  return nodes;
}

const GltfAnimation& animation_named(const GltfRig& rig, const std::string& name) {
  const std::vector<GltfAnimation>& all = rig.scene.animations;
  if (all.empty()) throw Error("has no animations", rig.file, "export the body with one");
  if (name.empty()) return all.front();
  std::vector<std::string> names;
  for (const GltfAnimation& animation : all) names.push_back(animation.name);
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw Error("has no animation `" + name + "`", rig.file, "it has " + joined(names));
  return all[found - names.begin()];
}

// The body's pose at a time: the joints' motion from the zero pose.
BodyPose animated_pose(const GltfRig& rig, const Points& zero, const GltfAnimation& animation, double time) {
  constexpr double most = 0.01;  // largest motion of a joint relative to its parent [m]
  const std::vector<Matrix4d> global = global_transforms(nodes_at(rig, animation, time));
  const Matrix4d to_mesh = rig.placed.inverse();
  BodyPose pose{Points(zero.rows(), 3), Vec3::Zero()};
  std::vector<Matrix4d> moved;
  for (int j = 0; j < zero.rows(); ++j) {
    const auto joint = static_cast<std::size_t>(rig.joints[j]);
    Matrix4d m = global[rig.scene.joints[joint]] * rig.scene.inverse_bind[joint] * to_mesh;
    const std::string& name = rig.body.joints[j];
    const auto fail = [&](const std::string& what) {
      throw Error(what, fmt::format("{}: animation `{}`, joint `{}` at {:.3f} s", rig.file, animation.name, name, time),
                  "bones keep their lengths here: clear scale and stretch of the bones before the export");
    };
    if (std::abs(size_of(m) - 1) > 0.01) fail("is scaled");
    m.topLeftCorner<3, 3>() = nearest_rotation(m.topLeftCorner<3, 3>());
    const Eigen::Vector4d at = row(zero, j).homogeneous();
    const int parent = rig.body.parents[j];
    Mat3 turn = m.topLeftCorner<3, 3>();
    if (parent < 0) {
      pose.translation = (m * at - at).head<3>();
    } else {
      const Matrix4d& above = moved[parent];
      if (const double off = (m * at - above * at).norm(); off > most)
        fail(fmt::format("moves by {:.0f} mm against its parent", 1000 * off));
      turn = above.topLeftCorner<3, 3>().transpose() * turn;
    }
    pose.rotations.row(j) = rotation_vector(turn).transpose();
    moved.push_back(m);
  }
  return pose;
}

}  // namespace

GltfRig read_gltf_rig(const std::filesystem::path& path, const NameChoice& choice) {
  GltfRig rig{path.string(), read_gltf(path, choice), {}, {}};
  const GltfScene& scene = rig.scene;
  const std::vector<int> parents = parents_among(scene);
  rig.joints = kept_joints(scene, parents, rig.file);
  const auto root = static_cast<std::size_t>(rig.joints[0]);
  rig.placed = global_transforms(scene.nodes)[scene.joints[root]] * scene.inverse_bind[root];
  if (size_of(rig.placed) == 0)
    throw Error("is scaled unevenly", rig.file + ": skin", "apply the armature's scale before the export");

  BodyModel& body = rig.body;
  body.name = path.stem().string();
  const Eigen::Matrix<double, 3, 4> placed = rig.placed.topRows<3>();
  body.skin.rest = scene.mesh.x.rowwise().homogeneous() * placed.transpose();
  body.skin.triangles = scene.mesh.triangles;
  if (size_of(rig.placed) < 0) body.skin.triangles.col(1).swap(body.skin.triangles.col(2));  // it mirrors the body
  body.meshes = scene.mesh.groups;
  std::vector<int> place(scene.joints.size(), 0);  // the root for joints that are left out
  std::vector<std::string> names;
  Points joints(static_cast<Eigen::Index>(rig.joints.size()), 3);
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const auto joint = static_cast<std::size_t>(rig.joints[j]);
    place[joint] = static_cast<int>(j);
    body.parents.push_back(j == 0 ? -1 : place[parents[joint]]);
    names.push_back(scene.nodes[scene.joints[joint]].name);
    if (!(std::abs(scene.inverse_bind[joint].determinant()) > 1e-12))
      throw Error("cannot be inverted", rig.file + ": skin, inverseBindMatrices of `" + names.back() + "`",
                  "export it anew");
    joints.row(static_cast<Eigen::Index>(j)) =
        (rig.placed * scene.inverse_bind[joint].inverse()).topRightCorner<3, 1>().transpose();
  }
  body.joints = joint_names(names, body.parents, rig.file);
  std::vector<Eigen::Triplet<double>> weights;
  for (Eigen::Index v = 0; v < scene.weights.rows(); ++v)
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator w(scene.weights, v); w; ++w)
      weights.emplace_back(v, place[w.col()], w.value());
  body.skin.weights = from_entries(scene.weights.rows(), joints.rows(), weights);
  body.skin.shape_directions.resize(3 * body.skin.rest.rows(), 0);
  body.regressor = exact_regressor(body.skin.rest, joints, rig.file + ": meshes");
  check_body(body, rig.file);
  return rig;
}

double gltf_rate(const GltfRig& rig, const std::string& name, std::vector<std::string>& warnings) {
  constexpr int least = 60, most = 240;
  const GltfAnimation& animation = animation_named(rig, name);
  const std::string noun = rig.file + ": animation `" + animation.name + "`";
  if (animation.morphs)
    warnings.push_back(noun +
                       " changes the weights of morph targets (shape keys), which are left out: the body keeps "
                       "the shape that the file gives it");
  double begin = animation.tracks.empty() ? 0 : std::numeric_limits<double>::infinity();
  for (const GltfTrack& track : animation.tracks) begin = std::min(begin, track.times[0]);
  warn_of_begin(noun, "first_frame: " + fmt::format("{:.0f}", std::ceil(begin * least)) + " leaves that out",
                {{begin, begin + 1}, 1}, warnings);
  const auto meets = [&](int rate) {
    return std::ranges::all_of(animation.tracks, [&](const GltfTrack& track) {
      const Eigen::ArrayXd at = rate * track.times.array();
      return (at - at.round()).abs().maxCoeff() < 1e-3;
    });
  };
  for (int rate = least; rate <= most; ++rate)
    if (meets(rate)) return rate;
  warnings.push_back(
      fmt::format("{} has keys at no steady rate: it is taken {} times a second, and between these it "
                  "moves steadily",
                  noun, most));
  return most;
}

Clip read_gltf_clip(const GltfRig& rig, const std::string& name, double fps) {
  const GltfAnimation& animation = animation_named(rig, name);
  double end = 0;
  for (const GltfTrack& track : animation.tracks) end = std::max(end, track.times[track.times.size() - 1]);
  constexpr double longest = 1e5;  // frames
  if (!(end * fps < longest))
    throw Error(fmt::format("is over {:.0f} poses long at {} a second", longest, fps),
                rig.file + ": animation `" + animation.name + "`", "cut it into shorter ones before the export");
  const Points zero = joint_positions(rig.body, {});
  Clip clip{animation.name, fps, rig.body.joints, {}, {}};
  const int frames = static_cast<int>(std::floor(end * fps + 1e-6)) + 1;
  for (int f = 0; f < frames; ++f) clip.poses.push_back(animated_pose(rig, zero, animation, f / fps));
  return clip;
}

}  // namespace selvedge

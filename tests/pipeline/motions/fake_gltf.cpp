#include "tests/pipeline/motions/fake_gltf.hpp"

#include <Eigen/Geometry>

namespace selvedge::fake {
namespace {

using Json = nlohmann::ordered_json;

template <class Number>
std::string bytes_of(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

int add_view(GltfFile& file, std::size_t begin, int component, Eigen::Index count, const char* type) {
  file.json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", file.bytes.size() - begin}});
  file.bytes.append((4 - file.bytes.size() % 4) % 4, '\0');
  file.json["accessors"].push_back({{"bufferView", file.json["bufferViews"].size() - 1},
                                    {"componentType", component},
                                    {"count", count},
                                    {"type", type}});
  return static_cast<int>(file.json["accessors"].size()) - 1;
}

Json listed(const Eigen::MatrixXd& values) { return std::vector<double>(values.data(), values.data() + values.size()); }

// In the armature's space, where the unit is a centimetre and Z is up.
Eigen::Matrix4d armature() {
  Eigen::Affine3d a =
      Eigen::Translation3d(0.3, 0.1, -0.2) * Eigen::AngleAxisd(-std::acos(0.0), Vec3::UnitX()) * Eigen::Scaling(0.01);
  return a.matrix();
}

// The axes of a joint's bone, some rotation.
Eigen::Matrix4d bone(const Vec3& joint, int number) {
  Eigen::Affine3d a = Eigen::Translation3d(joint) * Eigen::AngleAxisd(0.4 * number, Vec3(1, number, 2).normalized());
  return a.matrix();
}

// The joints in the armature's space, in a pose.
std::vector<Eigen::Matrix4d> bones(const BodyModel& body, const Points& joints, const BodyPose* pose) {
  std::vector<Eigen::Matrix4d> all;
  JointTransforms turned;
  if (pose) turned = joint_transforms(body, joints, *pose);
  const Eigen::Matrix4d to_armature = armature().inverse();
  for (int j = 0; j < joints.rows(); ++j) {
    Eigen::Matrix4d world = bone(row(joints, j), j);
    if (pose) {
      Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
      turn.topRows<3>() = turned[static_cast<std::size_t>(j)];
      turn.topRightCorner<3, 1>() += pose->translation;
      world = turn * world;
    }
    world.topLeftCorner<3, 3>() *= 0.01;
    all.push_back(to_armature * world);
  }
  return all;
}

// Relative to the parents; the root's to the joint above it, which lies at the armature's origin.
std::vector<Eigen::Matrix4d> local(const std::vector<Eigen::Matrix4d>& all, const std::vector<int>& parents) {
  std::vector<Eigen::Matrix4d> found;
  for (std::size_t j = 0; j < all.size(); ++j)
    found.push_back(parents[j] < 0 ? all[j]
                                   : Eigen::Matrix4d(all[static_cast<std::size_t>(parents[j])].inverse() * all[j]));
  return found;
}

Eigen::Vector4d quaternion(const Eigen::Matrix4d& m) {
  return Eigen::Quaterniond(Mat3(m.topLeftCorner<3, 3>())).normalized().coeffs();
}

void add_mesh(const BodyModel& body, GltfFile& file) {
  const Triangles& triangles = body.skin.triangles;
  const Eigen::Matrix4d to_armature = armature().inverse();
  Eigen::MatrixXd x(triangles.size(), 3), weights = Eigen::MatrixXd::Zero(triangles.size(), 8);
  Eigen::MatrixXi joints = Eigen::MatrixXi::Zero(triangles.size(), 8), corners(triangles.size(), 1);
  for (Eigen::Index i = 0; i < triangles.size(); ++i) {
    const int v = triangles.data()[i];
    x.row(i) = (to_armature * row(body.skin.rest, v).homogeneous()).head<3>().transpose();
    corners(i, 0) = static_cast<int>(i);
    int k = 0;
    for (SkinWeights::InnerIterator w(body.skin.weights, v); w; ++w, ++k) {
      joints(i, k) = static_cast<int>(w.col()) + 1;
      weights(i, k) = w.value();
    }
  }
  Json attributes = {{"POSITION", file.numbers(x, "VEC3")}};
  for (int set = 0; set < 2; ++set) {
    const std::string name = std::to_string(set);
    attributes["JOINTS_" + name] = file.whole(joints.middleCols(4 * set, 4), "VEC4", 5123);
    attributes["WEIGHTS_" + name] = file.numbers(weights.middleCols(4 * set, 4), "VEC4");
  }
  const Json primitive = {{"attributes", attributes}, {"indices", file.whole(corners, "SCALAR", 5125)}};
  file.json["meshes"] = Json::array({{{"name", "skin"}, {"primitives", Json::array({primitive})}}});
}

void add_animation(const BodyModel& body, const Points& joints, const Clip& clip, GltfFile& file) {
  const auto frames = static_cast<Eigen::Index>(clip.poses.size());
  std::vector<Eigen::MatrixXd> turn(body.joints.size(), Eigen::MatrixXd(frames, 4)),
      place(body.joints.size(), Eigen::MatrixXd(frames, 3));
  Eigen::MatrixXd times(frames, 1);
  for (Eigen::Index f = 0; f < frames; ++f) {
    times(f, 0) = static_cast<double>(f) / clip.fps;
    const auto all = local(bones(body, joints, &clip.poses[static_cast<std::size_t>(f)]), body.parents);
    for (std::size_t j = 0; j < all.size(); ++j) {
      turn[j].row(f) = quaternion(all[j]).transpose();
      place[j].row(f) = all[j].topRightCorner<3, 1>().transpose();
    }
  }
  Json channels = Json::array(), samplers = Json::array();
  const int input = file.numbers(times, "SCALAR");
  const auto add = [&](std::size_t joint, const char* path, int output) {
    channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", joint + 2}, {"path", path}}}});
    samplers.push_back({{"input", input}, {"output", output}});
  };
  for (std::size_t j = 0; j < body.joints.size(); ++j) {
    add(j, "rotation", file.numbers(turn[j], "VEC4"));
    add(j, "translation", file.numbers(place[j], "VEC3"));
  }
  file.json["animations"] = Json::array({{{"name", clip.name}, {"channels", channels}, {"samplers", samplers}}});
}

}  // namespace

int GltfFile::numbers(const Eigen::MatrixXd& values, const char* type) {
  const std::size_t begin = bytes.size();
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (Eigen::Index k = 0; k < values.cols(); ++k) bytes += bytes_of(static_cast<float>(values(i, k)));
  return add_view(*this, begin, 5126, values.rows(), type);
}

int GltfFile::whole(const Eigen::MatrixXi& values, const char* type, int component) {
  const std::size_t begin = bytes.size();
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (Eigen::Index k = 0; k < values.cols(); ++k)
      bytes += component == 5123 ? bytes_of(static_cast<std::uint16_t>(values(i, k)))
                                 : bytes_of(static_cast<std::uint32_t>(values(i, k)));
  return add_view(*this, begin, component, values.rows(), type);
}

std::string GltfFile::glb() const {
  Json all = json;
  if (!all.contains("buffers")) all["buffers"] = Json::array({{{"byteLength", bytes.size()}}});
  std::string text = all.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  const auto word = [](std::size_t value) { return bytes_of(static_cast<std::uint32_t>(value)); };
  return "glTF" + word(2) + word(20 + text.size() + 8 + bytes.size()) + word(text.size()) + "JSON" + text +
         word(bytes.size()) + std::string("BIN\0", 4) + bytes;
}

GltfFile gltf_of(const BodyModel& body, const Clip& clip, const std::vector<std::string>& names) {
  GltfFile file;
  file.json = {{"asset", {{"version", "2.0"}}}};
  const Points joints = joint_positions(body, {});
  const auto all = bones(body, joints, nullptr);
  const auto locals = local(all, body.parents);
  Json nodes = Json::array();  // the armature, the joint above the root, the joints, the mesh
  nodes.push_back({{"name", "Armature"}, {"matrix", listed(armature())}, {"children", {1, names.size() + 2}}});
  nodes.push_back({{"name", "above"}, {"children", {2}}});
  for (std::size_t j = 0; j < names.size(); ++j) {
    Json children = Json::array();
    for (std::size_t k = 0; k < names.size(); ++k)
      if (body.parents[k] == static_cast<int>(j)) children.push_back(k + 2);
    Json node = {{"name", names[j]},
                 {"rotation", listed(quaternion(locals[j]))},
                 {"translation", listed(locals[j].topRightCorner<3, 1>())}};
    if (!children.empty()) node["children"] = children;
    nodes.push_back(node);
  }
  nodes.push_back({{"name", "body"}, {"mesh", 0}, {"skin", 0}});
  file.json["nodes"] = nodes;
  file.json["scenes"] = Json::array({{{"nodes", {0}}}});
  file.json["scene"] = 0;
  Eigen::MatrixXd inverse(static_cast<Eigen::Index>(names.size()) + 1, 16);
  inverse.row(0) = Eigen::Matrix4d::Identity().reshaped().transpose();
  Json skin = {1};
  for (std::size_t j = 0; j < names.size(); ++j) {
    inverse.row(static_cast<Eigen::Index>(j) + 1) = all[j].inverse().reshaped().transpose();
    skin.push_back(j + 2);
  }
  file.json["skins"] = Json::array({{{"joints", skin}, {"inverseBindMatrices", file.numbers(inverse, "MAT4")}}});
  add_mesh(body, file);
  if (!clip.poses.empty()) add_animation(body, joints, clip, file);
  return file;
}

}  // namespace selvedge::fake

#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::fake {

// A body in MakeHuman's files: an octahedron round each of SMPL's 24 joints, with half of its weights on the parent,
// then helpers, which mark the beginnings of bones, away from the middles.
struct MakeHuman {
  static constexpr double radius = 0.02;
  Points joints;  // 24 x 3 [m]
  Vec3 off = Vec3(0.003, -0.002, 0.001);
  double unit = 0.1;  // of the files [m]
  nlohmann::json skeleton, weights;
  bool helpers = true;  // the mesh has helpers

  // SMPL's name, the bone with the weights of the joint's vertices, and the bones that begin there.
  struct Bone {
    std::string joint, weighted;
    std::vector<std::string> heads;
  };
  static std::vector<Bone> bones() {
    std::vector<Bone> all = {{"pelvis", "pelvis.L", {"spine05"}}, {"spine1", "spine03", {"spine03"}},
                             {"spine2", "breast.L", {"spine02"}}, {"spine3", "spine01", {"spine01"}},
                             {"neck", "neck02", {"neck01"}},      {"head", "eye.L", {"head"}}};
    for (const auto& [side, end] : {std::pair<std::string, std::string>{"left_", ".L"}, {"right_", ".R"}})
      for (const Bone& one :
           std::vector<Bone>{{"hip", "upperleg02", {"upperleg01"}},
                             {"knee", "lowerleg01", {"lowerleg01"}},
                             {"ankle", "foot", {"foot"}},
                             {"foot", "toe3-1", {"toe1-1", "toe2-1", "toe3-1", "toe4-1", "toe5-1"}},
                             {"collar", "shoulder01", {"clavicle"}},
                             {"shoulder", "upperarm01", {"upperarm01"}},
                             {"elbow", "lowerarm01", {"lowerarm01"}},
                             {"wrist", "finger1-1", {"wrist"}},
                             {"hand", "finger4-1", {"finger2-1", "finger3-1", "finger4-1", "finger5-1"}}}) {
        Bone bone{side + one.joint, one.weighted + end, {}};
        for (const std::string& head : one.heads) bone.heads.push_back(head + end);
        all.push_back(bone);
      }
    return all;
  }

  // The parents of the bones of the default skeleton.
  static std::map<std::string, std::string> parents() {
    std::map<std::string, std::string> above = {{"pelvis.L", "root"},   {"pelvis.R", "root"},   {"spine05", "root"},
                                                {"spine03", "spine05"}, {"spine02", "spine03"}, {"breast.L", "spine02"},
                                                {"spine01", "spine02"}, {"neck01", "spine01"},  {"neck02", "neck01"},
                                                {"head", "neck02"},     {"eye.L", "head"}};
    for (const std::string end : {".L", ".R"}) {
      for (const auto& [bone, parent] : std::vector<std::pair<std::string, std::string>>{{"upperleg01", "pelvis"},
                                                                                         {"upperleg02", "upperleg01"},
                                                                                         {"lowerleg01", "upperleg02"},
                                                                                         {"foot", "lowerleg01"},
                                                                                         {"shoulder01", "clavicle"},
                                                                                         {"upperarm01", "shoulder01"},
                                                                                         {"lowerarm01", "upperarm01"},
                                                                                         {"wrist", "lowerarm01"},
                                                                                         {"finger1-1", "wrist"}})
        above[bone + end] = parent + end;
      above["clavicle" + end] = "spine01";
      for (const char k : {'1', '2', '3', '4', '5'}) above[std::string("toe") + k + "-1" + end] = "foot" + end;
      for (const char k : {'2', '3', '4', '5'}) above[std::string("finger") + k + "-1" + end] = "wrist" + end;
    }
    return above;
  }

  explicit MakeHuman(const Points& at) : joints(at) {
    const std::vector<std::string> names = smpl_joint_names(24);
    std::vector<std::string> weighted(24), heads(24);
    std::map<std::string, int> helper;  // of a bone: the joint whose helper is its head
    for (const Bone& bone : bones()) {
      const auto j = std::find(names.begin(), names.end(), bone.joint) - names.begin();
      weighted[static_cast<std::size_t>(j)] = bone.weighted;
      for (const std::string& head : bone.heads) helper[head] = static_cast<int>(j);
    }
    skeleton = {{"name", "small"}, {"bones", {{"root", {{"parent", nullptr}, {"head", "root____head"}}}}}};
    skeleton["joints"]["root____head"] = {0};
    for (const auto& [bone, parent] : parents()) {
      const std::string head = bone + "____head";
      skeleton["bones"][bone] = {{"parent", parent}, {"head", head}, {"reference", nullptr}};
      const int first = 144 + 2 * (helper.contains(bone) ? helper[bone] : 0);
      skeleton["joints"][head] = {first, first + 1};
    }
    weights = {{"license", "none"}, {"weights", nlohmann::json::object()}};
    const auto add = [&](int vertex, int joint, double weight) {
      weights["weights"][weighted[static_cast<std::size_t>(joint)]].push_back({vertex, weight});
    };
    for (int v = 0; v < 144; ++v) {
      const int joint = v / 6, parent = smpl_joint_parents()[static_cast<std::size_t>(joint)];
      add(v, joint, 0.45);  // sums are not exactly 1
      add(v, std::max(parent, 0), 0.45);
    }
    for (int v = 144; v < 192; ++v) add(v, (v - 144) / 2, 1);
  }

  std::string mesh() const {
    std::string text = "# small\n";
    const auto vertex = [&](const Vec3& at) {
      text += fmt::format("v {} {} {}\n", at.x() / unit, at.y() / unit, at.z() / unit);
    };
    for (int v = 0; v < 144; ++v) vertex(row(joints, v / 6) + (v % 2 ? -radius : radius) * Vec3::Unit(v % 6 / 2));
    for (int v = 0; helpers && v < 48; ++v) vertex(row(joints, v / 2) + off + (v % 2 ? -1 : 1) * Vec3(0.01, 0.02, 0));
    if (helpers) text += "g helpers\nf 145 146 147\ng body\n";
    for (int o = 1; o <= 144; o += 6)
      for (const auto& [x, y, z] : std::vector<std::array<int, 3>>{
               {0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}})
        text += fmt::format("f {} {} {}\n", o + x, o + y, o + z);
    return text;
  }

  // Mesh, skeleton and weights.
  std::array<std::filesystem::path, 3> write(const Folder& folder) const {
    return {fake::write(folder, "small.obj", mesh()), fake::write(folder, "small.mhskel", skeleton.dump(1)),
            fake::write(folder, "small.mhw", weights.dump(1))};
  }
};

// A skeleton in MakeHuman's pose: arms down by 45 degrees, forearms bent forward, legs apart.
inline Points lowered(Points x) {
  for (int side = 0; side < 2; ++side) {
    const double m = side ? -1 : 1;
    const auto turn = [&](int pivot, std::vector<int> joints, const Vec3& axis, double angle) {
      const Vec3 center = row(x, pivot + side);
      const Eigen::AngleAxisd rotation(angle, axis);
      for (const int j : joints) x.row(j + side) = (center + rotation * Vec3(row(x, j + side) - center)).transpose();
    };
    turn(16, {18, 20, 22}, Vec3::UnitZ(), -m * 0.8);
    turn(18, {20, 22}, Vec3(m * 0.7, 0.7, 0).normalized(), -m * 0.9);
    turn(1, {4, 7, 10}, Vec3::UnitZ(), m * 0.15);
  }
  return x;
}

}  // namespace selvedge::fake

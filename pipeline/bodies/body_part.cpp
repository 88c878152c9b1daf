#include "pipeline/bodies/body_part.hpp"

#include <algorithm>
#include <array>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/smpl_joints.hpp"

namespace selvedge {

namespace {

// The group of each triangle, the first that has all of its corners; -1: it is of none.
std::vector<int> groups_of(const Mesh& mesh) {
  std::vector<int> group_of(static_cast<std::size_t>(mesh.triangles.rows()), -1);
  for (std::size_t g = mesh.groups.size(); g-- > 0;) {
    std::vector<char> in(static_cast<std::size_t>(mesh.x.rows()), 0);
    for (const int v : mesh.groups[g].second) in[static_cast<std::size_t>(v)] = 1;
    for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
      if (in[static_cast<std::size_t>(mesh.triangles(t, 0))] && in[static_cast<std::size_t>(mesh.triangles(t, 1))] &&
          in[static_cast<std::size_t>(mesh.triangles(t, 2))])
        group_of[static_cast<std::size_t>(t)] = static_cast<int>(g);
  }
  return group_of;
}

// Where no choice is made, the group `body` if there is one.
NameChoice of_body(const std::vector<std::string>& names, const NameChoice& choice) {
  return !choice.any() && std::ranges::count(names, "body") > 0 ? NameChoice{{"body"}, {}} : choice;
}

}  // namespace

BodyPart body_part(const Mesh& mesh, const std::filesystem::path& file, const NameChoice& asked) {
  std::vector<std::string> names;
  for (const auto& [group, vertices] : mesh.groups) names.push_back(group);
  asked.check(names, file.string());
  const NameChoice choice = of_body(names, asked);
  const std::vector<int> group_of = choice.any() ? groups_of(mesh) : std::vector<int>();
  std::vector<char> used(static_cast<std::size_t>(mesh.x.rows()), 0);
  std::vector<std::array<int, 3>> triangles;
  for (Eigen::Index at = 0; at < mesh.triangles.rows(); ++at) {
    const auto t = mesh.triangles.row(at);
    if (choice.any()) {
      const int group = group_of[static_cast<std::size_t>(at)];
      if (!choice.takes(group < 0 ? std::string() : names[static_cast<std::size_t>(group)])) continue;
    }
    triangles.push_back({t[0], t[1], t[2]});
    for (int k = 0; k < 3; ++k) used[static_cast<std::size_t>(t[k])] = 1;
  }
  if (triangles.empty())
    throw Error("has no faces of a body", file.string(), "the groups that are taken, or `body`, must have them");
  BodyPart part{{}, std::vector<int>(used.size(), -1), Triangles(static_cast<Eigen::Index>(triangles.size()), 3)};
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

BodyModel body_without_rig(const Mesh& mesh, const BodyPart& part, const std::filesystem::path& file) {
  BodyModel body;
  body.name = file.stem().string();
  body.joints = smpl_joint_names(smpl::joints);
  body.parents = smpl_joint_parents();
  body.skin.rest = mesh.x(part.vertices, Eigen::all);
  body.skin.triangles = part.triangles;
  body.skin.shape_directions.resize(body.skin.rest.size(), 0);
  for (const auto& [group, vertices] : mesh.groups) {
    std::vector<int> kept;
    for (const int v : vertices)
      if (const int at = part.row_of[static_cast<std::size_t>(v)]; at >= 0) kept.push_back(at);
    if (!kept.empty()) body.meshes.emplace_back(group, std::move(kept));
  }
  return body;
}

}  // namespace selvedge

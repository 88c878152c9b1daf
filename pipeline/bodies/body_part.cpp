#include "pipeline/bodies/body_part.hpp"

#include <algorithm>
#include <array>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/shapes/generate.hpp"

namespace selvedge {

namespace {

// 1 for each triangle that is taken: a chosen group has all of its corners, or no group has and triangles without group
// are chosen. Groups are lists of vertices and may overlap.
std::vector<char> taken_triangles(const Mesh& mesh, const NameChoice& choice) {
  const auto count = static_cast<std::size_t>(mesh.triangles.rows());
  std::vector<char> taken(count, 0), grouped(count, 0);
  for (const auto& [group, vertices] : mesh.groups) {
    std::vector<char> in(static_cast<std::size_t>(mesh.x.rows()), 0);
    for (const int v : vertices) in[v] = 1;
    for (std::size_t t = 0; t < count; ++t) {
      const auto corners = mesh.triangles.row(static_cast<Eigen::Index>(t));
      if (!std::ranges::all_of(corners, [&](int v) { return in[v] != 0; })) continue;
      grouped[t] = 1;
      if (choice.takes(group)) taken[t] = 1;
    }
  }
  for (std::size_t t = 0; t < count; ++t)
    if (!grouped[t] && choice.takes("")) taken[t] = 1;
  return taken;
}

// The choice, or without one the group `body` if it exists.
NameChoice of_body(const std::vector<std::string>& names, const NameChoice& choice) {
  return !choice.any() && std::ranges::count(names, "body") > 0 ? NameChoice{{"body"}, {}} : choice;
}

}  // namespace

BodyPart body_part(const Mesh& mesh, const std::filesystem::path& file, const NameChoice& asked) {
  std::vector<std::string> names;
  for (const auto& [group, vertices] : mesh.groups) names.push_back(group);
  asked.check(names, file.string());
  const std::vector<char> taken = taken_triangles(mesh, of_body(names, asked));
  std::vector<char> used(static_cast<std::size_t>(mesh.x.rows()), 0);
  std::vector<std::array<int, 3>> triangles;
  for (Eigen::Index at = 0; at < mesh.triangles.rows(); ++at) {
    if (!taken[at]) continue;
    const auto t = mesh.triangles.row(at);
    triangles.push_back({t[0], t[1], t[2]});
    for (int k = 0; k < 3; ++k) used[t[k]] = 1;
  }
  if (triangles.empty())
    throw Error("has no faces of a body", file.string(), "the groups that are taken, or `body`, must have them");
  BodyPart part{{}, std::vector<int>(used.size(), -1), {}};
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    part.row_of[v] = static_cast<int>(part.vertices.size());
    part.vertices.push_back(static_cast<int>(v));
  }
  part.triangles = to_triangles(triangles).unaryExpr([&](int v) { return part.row_of[v]; });
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
      if (const int at = part.row_of[v]; at >= 0) kept.push_back(at);
    if (!kept.empty()) body.meshes.emplace_back(group, std::move(kept));
  }
  return body;
}

}  // namespace selvedge

#include "pipeline/bodies/body_part.hpp"

#include <algorithm>
#include <array>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/smpl_joints.hpp"

namespace selvedge {

BodyPart body_part(const Mesh& mesh, const std::filesystem::path& file) {
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
  return body;
}

}  // namespace selvedge

#include "pipeline/garments/garment_dressed.hpp"

#include "pipeline/garments/garment_places.hpp"

namespace selvedge {
namespace {

// The garment whose mesh lies on the posed body: attached to the body's surface in that pose, then moved to zero pose
// and shape.
SkinnedSurface attached_in(const Dressing& how, const Mesh& mesh, const BodyModel& body) {
  BodyModel there = body;
  there.skin.rest = how.pose.rotations.rows() == 0 ? shaped(body.skin, how.shape) : posed(body, how.shape, how.pose);
  SkinnedSurface skin = attached(mesh.x, mesh.triangles, there, how.fit);
  const BodyPose zero{Points::Zero(static_cast<Eigen::Index>(body.joints.size()), 3)};
  const BodyPose& stands = how.pose.rotations.rows() == 0 ? zero : how.pose;
  skin.rest = unposed(skin, how.shape, stands, joint_transforms(body, joint_positions(body, how.shape), stands));
  return skin;
}

}  // namespace

DressedMesh dressed(const Mesh& mesh, const BodyModel& body, const Dressing& how) {
  DressedMesh made;
  Garment& garment = made.garment;
  garment.made_for = body.name;
  garment.made_in = how.pose;
  garment.skin = attached_in(how, mesh, body);
  garment.groups = mesh.groups;
  garment.look = mesh.look;
  std::vector<std::string> taken;
  for (const auto& [name, vertices] : mesh.groups) taken.push_back(name);
  for (NamedLoop& loop : named_loops(garment.skin, body, taken)) {
    if (loop.holds_up && how.pins.empty()) made.pinned.push_back(loop.name);
    garment.groups.emplace_back(loop.name, std::move(loop.vertices));
  }
  if (how.pins != std::vector<std::string>{"none"} && !how.pins.empty()) made.pinned = how.pins;
  garment.pins = pins_of(garment, made.pinned);
  return made;
}

}  // namespace selvedge

#include "pipeline/bodies/body_outward.hpp"

#include "collision/geometry/same_places.hpp"
#include "pipeline/shapes/outward_mesh.hpp"

namespace selvedge {

void turn_outward(const std::string& name, BodyModel& body, std::vector<std::string>& warnings) {
  turn_outward(name, body.meshes, {&body.skin.rest, 1}, same_places(body.skin.rest), body.skin.triangles, warnings);
}

OwnCrossings own_crossings(const BodyModel& body, const Eigen::VectorXd& shape) {
  return own_crossings(body.meshes, shaped(body.skin, shape), body.skin.triangles, same_places(body.skin.rest));
}

}  // namespace selvedge

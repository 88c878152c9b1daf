#include "pipeline/bodies/body_outward.hpp"

#include "pipeline/bodies/skin_places.hpp"
#include "pipeline/shapes/outward_mesh.hpp"

namespace selvedge {

void turn_outward(const std::string& name, BodyModel& body, std::vector<std::string>& warnings) {
  const bool solid =
      turn_outward(name, body.meshes, {&body.skin.rest, 1}, seam_places(body), body.skin.triangles, warnings);
  if (!solid)
    warnings.push_back(name +
                       ": no part of the body is closed, so that nothing is inside of it and cloth that gets there is "
                       "not pushed out; join its seams (`merge by distance`) and close its holes where it was made");
}

OwnCrossings own_crossings(const BodyModel& body, const Eigen::VectorXd& shape) {
  return own_crossings(body.meshes, shaped(body.skin, shape), body.skin.triangles, seam_places(body));
}

}  // namespace selvedge

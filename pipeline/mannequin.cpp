#include "pipeline/mannequin.hpp"

#include "pipeline/mannequin_form.hpp"
#include "pipeline/mannequin_skin.hpp"

namespace selvedge {

BodyModel make_mannequin() {
  const MannequinMesh mesh = mannequin_mesh();
  const Eigen::MatrixXd weights = mannequin_weights(mesh);
  BodyModel body;
  body.name = "mannequin";
  for (const MannequinJoint& joint : mannequin_joints()) {
    body.joints.emplace_back(joint.name);
    body.parents.push_back(joint.parent);
  }
  body.skin.weights = weights.sparseView(1, 0);
  body.skin.weights.makeCompressed();
  body.skin.shape_directions = mannequin_directions(mesh, weights);
  body.skin.pose_directions.resize(3 * mesh.x.rows(), 0);
  body.regressor = mannequin_regressor(mesh);
  body.skin.rest = mesh.x.rowwise() - mannequin_joints().front().position.transpose();
  body.skin.triangles = mesh.triangles;
  return body;
}

}  // namespace selvedge

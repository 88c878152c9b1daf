#include "pipeline/bodies/mannequin.hpp"

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_hdf5.hpp"
#include "pipeline/bodies/mannequin_form.hpp"
#include "pipeline/bodies/mannequin_skin.hpp"
#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

std::string mannequin_name() { return "mannequin " + std::to_string(mannequin_recipe); }

}  // namespace

BodyModel make_mannequin() {
  const MirroredMesh mesh = mannequin_mesh();
  const Eigen::MatrixXd weights = mannequin_weights(mesh);
  BodyModel body;
  body.name = mannequin_name();
  for (const MannequinJoint& joint : mannequin_joints()) {
    body.joints.emplace_back(joint.name);
    body.parents.push_back(joint.parent);
  }
  body.skin.weights = weights.sparseView(1, 0);
  body.skin.weights.makeCompressed();
  body.skin.shape_directions = mannequin_directions(mesh, weights);
  body.skin.pose_directions.resize(3 * mesh.shape.x.rows(), 0);
  body.regressor = mannequin_regressor(mesh.shape.x);
  body.skin.rest = mesh.shape.x.rowwise() - mannequin_joints().front().position.transpose();
  body.skin.triangles = mesh.shape.triangles;
  return body;
}

BodyModel kept_mannequin(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / ("mannequin-" + std::to_string(mannequin_recipe) + ".h5");
  if (!folder.empty() && std::filesystem::exists(file)) {
    try {
      BodyModel body = read_body(file);
      if (body.name == mannequin_name()) return body;
    } catch (const Error&) {  // another kind of file, or a damaged one: made anew below
    }
  }
  BodyModel body = make_mannequin();
  if (!folder.empty()) write_cached(file, [&] { write_body(file, body); });
  return body;
}

}  // namespace selvedge

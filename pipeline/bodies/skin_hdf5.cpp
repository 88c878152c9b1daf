#include "pipeline/bodies/skin_hdf5.hpp"

namespace selvedge::h5 {

SkinnedSurface read_skin(const Fields& fields, Eigen::Index joints) {
  SkinnedSurface skin;
  skin.rest = fields.points("rest");
  skin.triangles = fields.triangles("triangles");
  skin.weights = fields.sparse("weights", skin.rest.rows(), joints);
  skin.shape_directions = fields.directions("shape_directions", skin.rest.rows());
  skin.pose_directions = fields.directions("pose_directions", skin.rest.rows());
  return skin;
}

void write_skin(const File& file, const SkinnedSurface& skin) {
  write_points(file, "rest", skin.rest);
  write_triangles(file, "triangles", skin.triangles);
  write_sparse(file, "weights", skin.weights);
  write_directions(file, "shape_directions", skin.shape_directions);
  write_directions(file, "pose_directions", skin.pose_directions);
}

}  // namespace selvedge::h5

#include "pipeline/bodies/up_axis.hpp"

#include <cassert>
#include <cmath>

#include "pipeline/bodies/smpl_joints.hpp"

namespace selvedge {

Points with_y_up(const Points& x, Up up) {
  if (up == Up::y) return x;
  Points turned(x.rows(), 3);
  turned.col(0) = x.col(0);
  turned.col(1) = x.col(2);
  turned.col(2) = -x.col(1);
  return turned;
}

void turn_y_up(Up up, BodyModel& body) {
  assert(body.skin.pose_directions.cols() == 0);
  body.skin.rest = with_y_up(body.skin.rest, up);
  Eigen::MatrixXd& directions = body.skin.shape_directions;
  for (Eigen::Index k = 0; k < directions.cols(); ++k) {
    const Points column = Eigen::Map<const Points>(directions.col(k).data(), directions.rows() / 3, 3);
    Eigen::Map<Points>(directions.col(k).data(), directions.rows() / 3, 3) = with_y_up(column, up);
  }
}

bool stands_along_z(const BodyModel& body) {
  const std::vector<int> joints = smpl_joints_among(body.joints);
  if (const int pelvis = joints[smpl::pelvis], head = joints[smpl::head]; pelvis >= 0 && head >= 0) {
    const Points at = joint_positions(body, {});
    const Vec3 up = row(at, head) - row(at, pelvis);
    return std::abs(up.z()) > std::abs(up.y());
  }
  const Eigen::RowVector3d extent = body.skin.rest.colwise().maxCoeff() - body.skin.rest.colwise().minCoeff();
  return extent.z() > 1.5 * extent.y();
}

void warn_of_axis(const std::string& name, const BodyModel& body, std::vector<std::string>& warnings) {
  if (stands_along_z(body))
    warnings.push_back(name +
                       ": the body stands along z, and here y is up: make it anew with `selvedge body --up z`, or turn "
                       "it where it was made");
}

}  // namespace selvedge

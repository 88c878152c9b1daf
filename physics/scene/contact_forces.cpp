#include "physics/scene/contact_forces.hpp"

#include <limits>

namespace selvedge {
namespace {

ContactForces equal_contact_forces(Eigen::Index vertices, double value) {
  return {Points::Constant(vertices, 3, value), Points::Constant(vertices, 3, value),
          Eigen::VectorXd::Constant(vertices, value)};
}

}  // namespace

ContactForces unknown_contact_forces(Eigen::Index vertices) {
  return equal_contact_forces(vertices, std::numeric_limits<double>::quiet_NaN());
}

ContactForces no_contact_forces(Eigen::Index vertices) { return equal_contact_forces(vertices, 0); }

}  // namespace selvedge

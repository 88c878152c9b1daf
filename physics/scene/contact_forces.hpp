#pragma once

#include "collision/geometry/points.hpp"

namespace selvedge {

// What contact exerts on each vertex of the cloth at the end of a step (physics/solve/forces_of_terms.hpp says which
// forces these are). Rows that are not known are not a number.
struct ContactForces {
  Points normal, friction;   // the part along the contacts' normals, and the rest [N]
  Eigen::VectorXd pressure;  // normal force over the area at rest, on the side that is pressed more [Pa]
};

ContactForces unknown_contact_forces(Eigen::Index vertices);
ContactForces no_contact_forces(Eigen::Index vertices);  // zeros

}  // namespace selvedge

#pragma once

#include "physics/scene.hpp"

namespace selvedge {

struct Energies {  // [J]
  double kinetic = 0, gravity = 0, membrane = 0, bending = 0;
  double total() const { return kinetic + gravity + membrane + bending; }
};
Energies energies(const Scene&, const Points& x, const Points& v, const Vec3& acceleration);

// Principal stretches of every triangle: columns smallest, largest. 1 is rest.
Eigen::Matrix<double, Eigen::Dynamic, 2> principal_stretches(const Scene&, const Points& x);

Vec3 linear_momentum(const Scene&, const Points& v);
Vec3 angular_momentum(const Scene&, const Points& x, const Points& v);

}  // namespace selvedge

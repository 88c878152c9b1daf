#pragma once

#include <array>
#include <vector>

#include "physics/scene/scene.hpp"

namespace selvedge {

// Wind on a triangle, linearised about its velocity: force = D (wind - mean velocity of the corners), shared equally by
// the corners, with D = across n n^T + along (I - n n^T).
struct WindFace {
  std::array<int, 3> corners;
  Vec3 normal;
  double across = 0, along = 0;  // 1/2 rho cd A |u| and 1/2 rho cl A |u|, u: wind relative to the mean velocity [N s/m]
};

// One a triangle with an area, by its current area; none where Wind::on is false. D is positive semidefinite, so a step
// that takes the velocity at its end is stable in any wind.
std::vector<WindFace> wind_faces(const Scene&, const Points& x, const Points& v, const Vec3& wind);

// Their forces on every vertex at these velocities [N], n x 3: per triangle drag 1/2 rho cd A |u| (u . n) n and lift
// 1/2 rho cl A |u| (u - (u . n) n).
Points wind_forces(const Scene&, const Points& x, const Points& v, const Vec3& wind);

}  // namespace selvedge

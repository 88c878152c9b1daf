#pragma once

#include "physics/scene.hpp"

namespace selvedge {

// Wind force of every vertex [N], n x 3: per triangle, with u the wind relative to its mean velocity and n its normal,
// drag 1/2 rho cd A |u| (u . n) n and lift 1/2 rho cl A |u| (u - (u . n) n), shared equally by the corners.
// A is the current area. Zero where Wind::on is false.
Points wind_forces(const Scene&, const Points& x, const Points& v, const Vec3& wind);

}  // namespace selvedge

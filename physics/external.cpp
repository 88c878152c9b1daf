#include "physics/external.hpp"

namespace selvedge {

Points wind_forces(const Scene& scene, const Points& x, const Points& v, const Vec3& wind) {
  Points forces = Points::Zero(x.rows(), 3);
  if (!scene.wind.on) return forces;
  const double drag = 0.5 * scene.wind.air_density * scene.wind.drag,
               lift = 0.5 * scene.wind.air_density * scene.wind.lift;
  for (int t = 0; t < scene.surface.triangles.rows(); ++t) {
    const auto corner = scene.surface.triangles.row(t);
    const Vec3 x0 = row(x, corner(0));
    const Vec3 twice_area = (row(x, corner(1)) - x0).cross(row(x, corner(2)) - x0);
    const double length = twice_area.norm();
    if (!(length > 0)) continue;
    const Vec3 relative = wind - (row(v, corner(0)) + row(v, corner(1)) + row(v, corner(2))) / 3;
    const Vec3 normal = twice_area / length, along = relative.dot(normal) * normal;
    const Vec3 share = (0.5 * length / 3) * relative.norm() * (drag * along + lift * (relative - along));
    for (int k = 0; k < 3; ++k) forces.row(corner(k)) += share.transpose();
  }
  return forces;
}

}  // namespace selvedge

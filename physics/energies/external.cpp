#include "physics/energies/external.hpp"

namespace selvedge {
namespace {

Vec3 mean_of(const Points& points, const std::array<int, 3>& corners) {
  return (row(points, corners[0]) + row(points, corners[1]) + row(points, corners[2])) / 3;
}

}  // namespace

std::vector<WindFace> wind_faces(const Scene& scene, const Points& x, const Points& v, const Vec3& wind) {
  std::vector<WindFace> faces;
  if (!scene.wind.on) return faces;
  faces.reserve(static_cast<std::size_t>(scene.surface.triangles.rows()));
  const double drag = 0.5 * scene.wind.air_density * scene.wind.drag,
               lift = 0.5 * scene.wind.air_density * scene.wind.lift;
  for (int t = 0; t < scene.surface.triangles.rows(); ++t) {
    const auto corner = scene.surface.triangles.row(t);
    WindFace face{{corner(0), corner(1), corner(2)}, Vec3::Zero()};
    const Vec3 x0 = row(x, corner(0));
    const Vec3 twice_area = (row(x, corner(1)) - x0).cross(row(x, corner(2)) - x0);
    const double length = twice_area.norm();
    if (!(length > 0)) continue;
    face.normal = twice_area / length;
    const double speed = (wind - mean_of(v, face.corners)).norm();
    face.across = 0.5 * length * drag * speed;
    face.along = 0.5 * length * lift * speed;
    faces.push_back(face);
  }
  return faces;
}

Points wind_forces(const Scene& scene, const Points& x, const Points& v, const Vec3& wind) {
  Points forces = Points::Zero(x.rows(), 3);
  for (const WindFace& face : wind_faces(scene, x, v, wind)) {
    const Vec3 relative = wind - mean_of(v, face.corners), across = relative.dot(face.normal) * face.normal;
    const Vec3 share = (face.across * across + face.along * (relative - across)) / 3;
    for (const int corner : face.corners) forces.row(corner) += share.transpose();
  }
  return forces;
}

}  // namespace selvedge

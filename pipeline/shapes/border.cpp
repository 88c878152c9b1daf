#include "pipeline/shapes/border.hpp"

#include <algorithm>

namespace selvedge {

Border border(const Plane& plane) {
  return {[plane](const Vec3& p) { return plane.signedDistance(p); },
          [plane](const Vec3& p) -> Vec3 { return plane.projection(p); }};
}

Border border_round(const Vec3& centre, const Vec3& radii) {
  const auto outward = [centre](const Vec3& p) {
    Vec3 from = p - centre;
    from.y() = std::min(from.y(), 0.0);
    return from;
  };
  const auto norm = [outward, radii](const Vec3& p) { return outward(p).cwiseQuotient(radii).norm(); };
  return {[norm, radii](const Vec3& p) { return radii.minCoeff() * (1 - norm(p)); },
          [norm, outward](const Vec3& p) -> Vec3 { return p + outward(p) * (1 / norm(p) - 1); }};
}

}  // namespace selvedge

#pragma once

#include <optional>
#include <vector>

#include "physics/scene/scene.hpp"

namespace selvedge {

// The plane of all x with normal . x = offset.
struct CutPlane {
  Vec3 normal = Vec3::UnitY();
  double offset = 0;  // [m]
};

// Length of a tape round the section of these triangles, its convex hull, and the middle of that; absent where the
// plane misses them.
struct BodyGirth {
  double length = 0;  // [m]
  Vec3 middle = Vec3::Zero();
};
std::optional<BodyGirth> body_girth(const Triangles&, const std::vector<int>& which, const Points& x, const CutPlane&);

// Length of a cloth's section as it is at rest [m]. Absent where it does not go all round `middle`: seen from there, an
// opening of more than 30 degrees.
std::optional<double> girth_at_rest(const Triangles&, const std::vector<RestTriangle>&, const std::vector<int>& which,
                                    const Points& x, const CutPlane&, const Vec3& middle);

}  // namespace selvedge

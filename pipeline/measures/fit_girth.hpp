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

// The middle of the box round the section of the triangles `which`; absent if the plane misses them.
std::optional<Vec3> section_middle(const Surface&, const std::vector<int>& which, const Points& x, const CutPlane&);

// Length of a tape round the body's section: that of its convex hull [m]. Only loops of the section that go round
// `middle` count; absent without any.
std::optional<double> body_girth(const Surface&, const Points& x, const CutPlane&, const Vec3& middle);

// Rest length of a cloth's section [m], of the loops that go round `middle`. Absent without any: a section that ends at
// a boundary is not a loop.
std::optional<double> girth_at_rest(const Scene&, const Cloth&, const Points& x, const CutPlane&, const Vec3& middle);

}  // namespace selvedge

#pragma once

#include <functional>
#include <vector>

#include "pipeline/shapes/border.hpp"
#include "pipeline/shapes/primitives.hpp"

namespace selvedge {

struct RemeshTarget {
  std::function<double(const Vec3&)> edge;                         // wanted length of edges near a point [m]
  std::function<Vec3(const Vec3&)> surface;                        // moves a point near the surface onto it
  std::vector<Border> borders{border(Plane(Vec3::UnitX(), 0.0))};  // in which the boundary lies
};

// Remeshes a surface with even triangles, by splitting, collapsing and flipping edges and moving vertices along the
// surface (Botsch and Kobbelt 2004). The boundary stays in its borders. Corners between two borders stay in place (of
// two adjacent ones only one does). No inner edge joins two boundary vertices, so that a half and its mirror image fit
// together. Parts thinner than an edge may lose their thickness. The same input gives the same bits.
Shape remeshed(const Shape&, const RemeshTarget&, int rounds);

}  // namespace selvedge

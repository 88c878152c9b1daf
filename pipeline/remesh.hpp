#pragma once

#include <functional>

#include "pipeline/primitives.hpp"

namespace selvedge {

struct RemeshTarget {
  std::function<double(const Vec3&)> edge;   // length that edges near a point are to have [m]
  std::function<Vec3(const Vec3&)> surface;  // a point near the surface, brought onto it
};

// Even triangles of a surface, by splitting, collapsing and flipping edges and moving vertices along the surface
// (Botsch and Kobbelt 2004). The surface may have a boundary in the plane x = 0, which stays there, so that the mesh
// and its mirror image close each other. What is thinner than an edge may lose its thickness. The same input gives the
// same bits.
Shape remeshed(Shape, const RemeshTarget&, int rounds);

}  // namespace selvedge

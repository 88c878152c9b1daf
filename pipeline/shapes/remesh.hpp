#pragma once

#include <functional>
#include <vector>

#include "pipeline/shapes/border.hpp"
#include "pipeline/shapes/primitives.hpp"

namespace selvedge {

struct RemeshTarget {
  std::function<double(const Vec3&)> edge;                         // length that edges near a point are to have [m]
  std::function<Vec3(const Vec3&)> surface;                        // a point near the surface, brought onto it
  std::vector<Border> borders{border(Plane(Vec3::UnitX(), 0.0))};  // that the boundary lies in
};

// Even triangles of a surface, by splitting, collapsing and flipping edges and moving vertices along the surface
// (Botsch and Kobbelt 2004). The boundary stays in its borders, corners between two of them stay where they are (of two
// beside each other one does), and no inner edge joins two boundary vertices, so that a half and its mirror image close
// each other. What is thinner than an edge may lose its thickness. The same input gives the same bits.
Shape remeshed(Shape, const RemeshTarget&, int rounds);

}  // namespace selvedge

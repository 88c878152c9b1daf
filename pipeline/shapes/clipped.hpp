#pragma once

#include <span>

#include "pipeline/shapes/border.hpp"
#include "pipeline/shapes/primitives.hpp"

namespace selvedge {

// What of a surface the border keeps. Its new boundary lies in the border: triangles that cross it are cut, vertices
// within `snap` of it are moved onto it [m]. What lies in the borders of earlier cuts stays in them. Vertices without
// triangles are dropped.
Shape clipped(const Shape&, const Border&, std::span<const Border> earlier, double snap);

// The component with most vertices.
Shape largest_component(const Shape&);

}  // namespace selvedge

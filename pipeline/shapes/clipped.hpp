#pragma once

#include <span>

#include "pipeline/shapes/border.hpp"
#include "pipeline/shapes/primitives.hpp"

namespace selvedge {

// The part of a surface that the border keeps. Triangles that cross the border are cut, and vertices within `snap` [m]
// are moved onto it. Vertices on borders of earlier cuts stay on them. Vertices without triangles are dropped.
Shape clipped(const Shape&, const Border&, std::span<const Border> earlier, double snap);

// The component with most vertices.
Shape largest_component(const Shape&);

}  // namespace selvedge

#pragma once

#include <functional>
#include <vector>

#include "pipeline/shapes/primitives.hpp"

namespace selvedge {

// A surface and its image in the plane x = 0.
struct MirroredMesh {
  Shape shape;            // the half as it was, then the images
  int half = 0;           // vertices of the half
  std::vector<int> twin;  // of each vertex: its image, itself where the two are joined
};

// Joins a half at x >= 0 with its mirror image at its vertices at x = 0 that `joined` accepts (all, if it is empty).
// Other vertices at x = 0 get images of their own.
MirroredMesh mirrored(const Shape& half, const std::function<bool(int vertex)>& joined = {});

}  // namespace selvedge

#pragma once

#include <optional>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// A surface's topology after joining vertices that always lie at one place, so that the seam of a texture is no border.
// All vertices keep their numbers; one that another vertex stands for becomes isolated.
struct WeldedSurface {
  Surface surface;
  std::vector<int> joined;  // of each vertex the one that stands for it, the lowest
};

// The places of a triangle's corners in its order, the lowest first; nothing where two are the same.
std::optional<std::array<int, 3>> placed_corners(const Triangles&, int triangle, const std::vector<int>& places);

// `places`: of each vertex the lowest one at its place (same_places.hpp). Faces are joined along an edge only where
// exactly two meet. Where an edge would have more than two faces all the same, as a flap that is a single face has on
// the face that it lies on, an end of it stays apart, with the edges there. Faces whose corners lie at fewer than three
// places are left out, and so are those that repeat a face. Absent where nothing was joined.
std::optional<WeldedSurface> welded_surface(const Surface&, const std::vector<int>& places);

// Moves each vertex to the vertex that stands for it. `joined` may be empty.
void hold_together(const std::vector<int>& joined, Points&);

}  // namespace selvedge

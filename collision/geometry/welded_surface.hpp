#pragma once

#include <optional>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// A surface's topology with vertices joined that always lie at one place: the seam of a texture is no border. All
// vertices keep their numbers; those that another one stands for are isolated.
struct WeldedSurface {
  Surface surface;
  std::vector<int> joined;  // of each vertex the one that stands for it, the lowest
};

// `places`: of each vertex the lowest one at its place (same_places.hpp). Two faces are joined where they alone meet
// along an edge, so that no edge gets more than two faces which had fewer. Faces whose corners lie at fewer than three
// places are left out, and so are those that repeat a face. Absent where that changes nothing.
std::optional<WeldedSurface> welded_surface(const Surface&, const std::vector<int>& places);

// Puts joined vertices where those are that stand for them.
void hold_together(const WeldedSurface&, Points&);

}  // namespace selvedge

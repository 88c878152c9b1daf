#pragma once

#include <string>
#include <vector>

#include "pipeline/scene/cloth_part.hpp"

// Vertices whose triangles have no area at rest, as files have them where polygons with points on straight edges were
// cut up. They have no mass, so that no force moves them, and must hold nothing.
namespace selvedge {

// Leaves out the triangles without area of vertices that have no other, so that nothing meets them, and makes these
// vertices followers of the nearest triangle that is joined to them. A vertex that is joined to nothing with area stays
// where it is. Other triangles without area are left out where they have an edge that no other has: such an edge lies
// on the cloth beside it and would meet it for ever. Counted in a warning.
void leave_out_massless(ClothPart&, std::vector<std::string>& warnings);

// The followers of all cloths by the scene's numbers, but for vertices that a cloth's own pins hold.
std::vector<Follower> followers_of(const std::vector<ClothPart>&, const Scene&);

}  // namespace selvedge

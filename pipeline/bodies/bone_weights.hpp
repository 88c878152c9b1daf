#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"
#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Skinning weights from the places of joints alone: each vertex takes the joint of the nearest bone that the surface
// does not hide from it, and the weights spread over the surface as heat from the bones does (Baran, Popovic 2007,
// "Automatic rigging and animation of 3D characters", section 4). A joint's bones go to its children; where it has none
// its bone goes on from the parent's, half as long. n x joints, rows sum to 1, entries below 1e-3 left out. The surface
// need not be closed; a piece of it that no bone is seen from takes the nearest.
SkinWeights bone_weights(const Surface&, const Points& rest, const Points& joints, const std::vector<int>& parents);

}  // namespace selvedge

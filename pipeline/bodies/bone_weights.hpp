#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"
#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Skinning weights from the places of joints alone: each vertex takes the joint of the nearest bone that the surface
// does not hide from it, and weights spread over the surface as heat from the bones (Baran, Popovic 2007, "Automatic
// rigging and animation of 3D characters", section 4). A joint's bones lead to its children; without children its bone
// continues the parent's, half as long. n x joints, rows sum to 1, entries below 1e-3 are left out. The surface need
// not be closed; a piece from which no bone is visible takes the nearest bone.
SkinWeights bone_weights(const Surface&, const Points& rest, const Points& joints, const std::vector<int>& parents);

}  // namespace selvedge

#pragma once

#include "pipeline/config/config.hpp"
#include "pipeline/scene/cloth_part.hpp"

namespace selvedge {

// The stitches of garments among `parts`, the cloths of a scene, and then its `springs` list. Cloths are numbered on
// end in `scene` and at x at the start. Stitches are as long as in the garment, times the body's scale. Springs that
// are shorter at rest than the contact thickness are warned of: contact pushes apart what they pull together.
std::vector<Spring> read_springs(const Config& list, const std::vector<ClothPart>& parts, const Scene& scene,
                                 const Points& x, std::vector<std::string>& warnings);

}  // namespace selvedge

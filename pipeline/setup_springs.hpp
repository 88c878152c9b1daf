#pragma once

#include "pipeline/setup_cloth.hpp"

namespace selvedge {

// The `springs` list of a scene whose cloths are `parts`, numbered on end in `scene` and at x at the start. Springs
// that are shorter at rest than the contact thickness are warned of: contact pushes apart what they pull together.
std::vector<Spring> read_springs(const Config& list, const std::vector<ClothPart>& parts, const Scene& scene,
                                 const Points& x, std::vector<std::string>& warnings);

}  // namespace selvedge

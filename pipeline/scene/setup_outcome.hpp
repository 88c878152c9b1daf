#pragma once

#include "pipeline/scene/outcome.hpp"
#include "pipeline/scene/setup_cloth.hpp"

namespace selvedge {

// The `outcome` list of a scene whose cloths are `parts`, numbered on end in `scene`.
std::vector<Outcome> read_outcomes(const Config& list, const std::vector<ClothPart>& parts, const Scene& scene);

}  // namespace selvedge

#pragma once

#include "pipeline/config/config.hpp"
#include "pipeline/scene/cloth_part.hpp"
#include "pipeline/scene/outcome.hpp"

namespace selvedge {

// The `outcome` list of a scene whose cloths are `parts`, numbered on end in `scene`.
std::vector<Outcome> read_outcomes(const Config& list, const std::vector<ClothPart>& parts, const Scene& scene);

}  // namespace selvedge

#pragma once

#include <filesystem>

#include "pipeline/config/config.hpp"
#include "pipeline/scene/cloth_part.hpp"

namespace selvedge {

// Sews a placed cloth as its `seams` list asks: vertices of a pair become one, in the middle of all that become one
// with it, with the lowest of their numbers; the numbers of those that vanish are closed up. Groups follow, the rest
// metric stays. Throws Error, with the pair, where that does not leave a manifold surface; panels that face opposite
// ways are warned of.
void sew(const Config& list, const std::filesystem::path& folder, ClothPart&, std::vector<std::string>& warnings);

// Warns of seams that start stretched because sewn vertices were apart; x: of the scene.
void warn_of_stretched_seams(const std::vector<ClothPart>& parts, const Scene& scene, const Points& x,
                             std::vector<std::string>& warnings);

}  // namespace selvedge

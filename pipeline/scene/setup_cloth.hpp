#pragma once

#include <filesystem>

#include "pipeline/config/config.hpp"
#include "pipeline/scene/cloth_part.hpp"

namespace selvedge {

// The cloth of a section, or its copies. `folder` is the scene file's; warnings are added. The material's values are
// written back into the section.
std::vector<ClothPart> read_cloths(Config& section, const std::string& default_name,
                                   const std::filesystem::path& folder, const Performances&,
                                   std::vector<std::string>& warnings);

// The flat metric of every triangle, v along the part of `weft` in the triangle's plane.
std::vector<RestTriangle> flattened(const Points& x, const Triangles&, const Vec3& weft);

}  // namespace selvedge

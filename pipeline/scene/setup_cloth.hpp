#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/config/config.hpp"
#include "pipeline/scene/cloth_part.hpp"

namespace selvedge {

// The cloth of a section, or its copies. `folder` is the scene file's; warnings are added. The material's values are
// written back into the section.
std::vector<ClothPart> read_cloths(Config& section, const std::string& default_name,
                                   const std::filesystem::path& folder, const Performances&,
                                   std::vector<std::string>& warnings);

// The cloth of a section that a body wears, with its material, start and pins. `folder` is that of the files that the
// section names.
ClothPart worn_cloth(Config& section, const std::string& name, std::shared_ptr<const Wearing>,
                     const std::filesystem::path& folder, std::vector<std::string>& warnings);

// The flat metric of every triangle, v along the part of `weft` in the triangle's plane.
std::vector<RestTriangle> flattened(const Points& x, const Triangles&, const Vec3& weft);

}  // namespace selvedge

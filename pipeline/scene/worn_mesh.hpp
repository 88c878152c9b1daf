#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/scene/cloth_part.hpp"

namespace selvedge {

// The mesh as a garment of the body that the `cloth` section names. It lies where the body wears it in its zero pose.
// `pins`: vertices that stay with the body, ascending; absent: those that Dressing (garment_dressed.hpp) chooses.
// Throws Error for a mesh that is not on the body.
std::shared_ptr<const Wearing> wear_mesh(const Config& cloth, const std::string& name, const Mesh&,
                                         const std::optional<std::vector<int>>& pins, const Performances&);

// The cloth of that section, with its material, start and pins. `folder` is that of the files that it names.
ClothPart worn_cloth(Config& cloth, const std::string& name, std::shared_ptr<const Wearing>,
                     const std::filesystem::path& folder, std::vector<std::string>& warnings);

}  // namespace selvedge

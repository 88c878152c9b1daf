#pragma once

#include <span>

#include "pipeline/exports/animated_surfaces.hpp"

namespace selvedge {

// The materials of several surfaces in one file: those that are the same once, others of one name with a number.
struct ExportMaterials {
  std::vector<LookMaterial> all;
  std::vector<std::vector<int>> of;  // of each surface: the numbers of its look's materials
};

ExportMaterials export_materials(std::span<const AnimatedSurface>);

// The name, or where a material has it the name with a number.
std::string unused_name(const std::string& name, const std::vector<LookMaterial>&);

}  // namespace selvedge

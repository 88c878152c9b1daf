#include "pipeline/exports/export_materials.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace selvedge {

ExportMaterials export_materials(const std::vector<AnimatedSurface>& surfaces) {
  ExportMaterials materials;
  std::vector<LookMaterial> given;  // as the files have them
  for (const AnimatedSurface& surface : surfaces) {
    std::vector<int>& own = materials.of.emplace_back();
    for (const LookMaterial& material : surface.look.materials) {
      const auto known = std::ranges::find(given, material);
      own.push_back(static_cast<int>(known - given.begin()));
      if (known != given.end()) continue;
      given.push_back(material);
      LookMaterial named = material;
      for (int k = 1; std::ranges::find(materials.all, named.name, &LookMaterial::name) != materials.all.end(); ++k)
        named.name = fmt::format("{}_{}", material.name, k);
      materials.all.push_back(std::move(named));
    }
  }
  return materials;
}

}  // namespace selvedge

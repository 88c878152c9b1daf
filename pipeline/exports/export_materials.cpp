#include "pipeline/exports/export_materials.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace selvedge {

std::string unused_name(const std::string& name, const std::vector<LookMaterial>& materials) {
  std::string unused = name;
  for (int k = 1; std::ranges::find(materials, unused, &LookMaterial::name) != materials.end(); ++k)
    unused = fmt::format("{}_{}", name, k);
  return unused;
}

ExportMaterials export_materials(std::span<const AnimatedSurface> surfaces) {
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
      named.name = unused_name(material.name, materials.all);
      materials.all.push_back(std::move(named));
    }
  }
  return materials;
}

}  // namespace selvedge

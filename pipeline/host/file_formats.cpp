#include "pipeline/host/file_formats.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "pipeline/host/lower_extension.hpp"

namespace selvedge {

bool is_gltf(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".glb" || extension == ".gltf" || extension == ".vrm";
}

std::string export_cure(const std::filesystem::path& file, const std::string& as, const std::string& otherwise) {
  constexpr std::array<std::string_view, 14> others = {".fbx", ".dae", ".blend", ".usd", ".usda", ".usdc", ".usdz",
                                                       ".abc", ".stl", ".3ds",   ".ma",  ".mb",   ".max",  ".zprj"};
  if (std::ranges::find(others, lower_extension(file)) == others.end()) return otherwise;
  return "open it in the program that made it, or in Blender, and export it as " + as;
}

}  // namespace selvedge

#pragma once

#include <filesystem>
#include <string>

namespace selvedge {

// Whether a file's name is one of glTF 2.0: .glb, .gltf, or .vrm, which is a .glb with more in it.
bool is_gltf(const std::filesystem::path&);

// The cure for a file that cannot be read: for a format of other programs, such as FBX, to export it `as` another one;
// else `otherwise`.
std::string export_cure(const std::filesystem::path&, const std::string& as, const std::string& otherwise);

}  // namespace selvedge

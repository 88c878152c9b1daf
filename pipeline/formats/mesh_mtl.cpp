#include "pipeline/formats/mesh_mtl.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/config/config_units.hpp"
#include "pipeline/formats/line_words.hpp"
#include "pipeline/host/read_file.hpp"

namespace selvedge {
namespace {

// None for what is no colour, such as `Kd spectral FILE`. One number stands for all three.
std::optional<Vec3> colour_of(const std::vector<std::string_view>& words) {
  Vec3 colour;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = read_number(words[words.size() > 3 ? k + 1 : 1]);
    if (!value || !(*value >= 0 && *value <= 1)) return {};
    colour[static_cast<Eigen::Index>(k)] = *value;
  }
  return colour;
}

// The file of a texture's line, after its options: `-s 1 1 1 cloth.png`.
std::string texture_of(const std::vector<std::string_view>& words) {
  std::size_t k = 1;
  while (k + 1 < words.size() && words[k].starts_with('-') && words[k].size() > 1) {
    const bool plain_word = words[k] == "-imfchan" || words[k] == "-type";
    for (++k; k + 1 < words.size() && (read_number(words[k]) || words[k] == "on" || words[k] == "off");) ++k;
    if (plain_word && k + 1 < words.size()) ++k;
  }
  std::string file = joined_from(words, k);
  std::ranges::replace(file, '\\', '/');
  const bool drive = file.size() > 1 && file[1] == ':' && std::isalpha(static_cast<unsigned char>(file[0]));
  return file.starts_with('/') || drive ? file.substr(file.rfind('/') + 1) : file;
}

// The files that a line `mtllib` names: one with blanks in its name if there is such a one, else several.
std::vector<std::string> mtl_files(const std::filesystem::path& folder, const std::string& line) {
  const auto is_there = [&](const std::string& name) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(folder / name, ignored);
  };
  std::vector<std::string> names;
  for (const std::string_view word : split_words(line)) names.emplace_back(word);
  return is_there(line) || std::ranges::none_of(names, is_there) ? std::vector{line} : names;
}

// Fills in the colours (Kd) and textures (map_Kd) that the text of a .mtl file gives for materials of these names.
// Other lines and other materials are passed over. Of a texture with an absolute path the file's name is kept.
void parse_mtl(std::string_view text, std::vector<LookMaterial>& materials) {
  auto open = materials.end();
  while (!text.empty()) {
    const std::vector<std::string_view> words = split_words(without_comment(take_line(text)));
    if (words.size() < 2) continue;
    if (words[0] == "newmtl")
      open = std::ranges::find(materials, joined_from(words, 1), &LookMaterial::name);
    else if (words[0] == "Kd" && open != materials.end())
      open->colour = colour_of(words);
    else if (words[0] == "map_Kd" && open != materials.end())
      open->texture = texture_of(words);
  }
}

}  // namespace

void read_materials(Mesh& mesh, MissingMtl missing) {
  if (mesh.look.materials.empty()) return;
  for (const auto& [folder, line] : mesh.material_files)
    for (const std::string& name : mtl_files(folder, line)) {
      try {
        parse_mtl(read_text_file(path_below(folder, name, folder.string()), "material"), mesh.look.materials);
      } catch (const Error&) {
        if (missing == MissingMtl::ignore) continue;
        mesh.warnings.push_back(
            fmt::format("the material file `{}` cannot be read from the mesh's folder {}: its colours and textures "
                        "are left out",
                        name, folder.string()));
      }
    }
}

std::string mtl_text(const std::vector<LookMaterial>& materials) {
  std::string text;
  for (const LookMaterial& material : materials) {
    text += fmt::format("newmtl {}\n", material.name);
    if (const auto& c = material.colour) text += fmt::format("Kd {} {} {}\n", c->x(), c->y(), c->z());
    if (!material.texture.empty()) text += fmt::format("map_Kd {}\n", material.texture);
  }
  return text;
}

}  // namespace selvedge

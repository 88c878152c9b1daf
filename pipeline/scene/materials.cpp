#include "pipeline/scene/materials.hpp"

#include <algorithm>

#include "physics/scene/scene_numbers.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/scene/config_scene.hpp"

namespace selvedge {
namespace {

namespace fs = std::filesystem;

void apply_hinge(const Config& section, Material& material) {
  const Config& hinge = section["hinge_bending"];
  if (!hinge.given) return;
  if (section["bending"].given) hinge.fail("is given beside bending", "give one of them");
  if (section["bending_model"].given && section["bending_model"].text() != "hinge")
    hinge.fail("is given beside bending_model: " + section["bending_model"].text(), "leave bending_model out");
  material.bending_model = BendingModel::hinge;
  material.bending = hinge.number();
}

// Young's modulus, with or without a thickness, and Poisson's ratio, in place of the Lame coefficients.
void apply_elastic(const Config& section, Material& material) {
  const Config &young = section["youngs_modulus"], &poisson = section["poisson"], &modulus = section["modulus"],
               &thickness = section["thickness"];
  if (modulus.given != thickness.given)
    (modulus.given ? modulus : thickness).fail("stands alone", "give modulus, thickness and poisson");
  if (modulus.given && young.given) modulus.fail("is given beside youngs_modulus", "give one of them");
  const bool given = young.given || modulus.given;
  if (given != poisson.given)
    (young.given     ? young
     : modulus.given ? modulus
                     : poisson)
        .fail("stands alone", "give both youngs_modulus and poisson, or modulus, thickness and poisson");
  if (!given) return;
  for (const char* lame : {"lame_mu", "lame_lambda"})
    if (section[lame].given)
      section[lame].fail("is given beside youngs_modulus or modulus, and poisson", "give one pair or the other");
  const double nu = poisson.number(), h = modulus.given ? thickness.number() : 0;
  const double e = modulus.given ? modulus.number() * h : young.number();
  set_elasticity({e, nu}, section.where, material);
  if (modulus.given && !section["bending"].given && !section["hinge_bending"].given)
    material.bending = e * h * h / (12 * (1 - nu * nu));
}

void apply(const Config& section, Material& material) {
  read_options(material_options(), section, material);
  apply_hinge(section, material);
  apply_elastic(section, material);
}

void read_named(const Config& name, const fs::path& folder, Material& material) {
  material.name = name.text();
  for (const fs::path& place : config_folders(folder)) {
    const fs::path file = place / "materials" / (name.text() + ".yaml");
    if (fs::exists(file)) return apply(read_config(file, material_file_section()), material);
  }
  if (name.text() == Material{}.name) return;
  const std::vector<std::string> known = material_names(folder);
  name.fail("names the unknown material `" + name.text() + "`",
            "known: " + joined(known) + suggestion(name.text(), known));
}

void write_back(const Material& material, Config& section) {
  write_options(material_options(), material, section);
  for (const char* replaced : {"youngs_modulus", "modulus", "thickness", "poisson", "hinge_bending"}) {
    section[replaced].numbers.clear();
    section[replaced].given = false;
  }
}

}  // namespace

std::vector<std::string> material_names(const fs::path& folder) {
  std::vector<std::string> names{Material{}.name};
  for (const fs::path& place : config_folders(folder)) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(place / "materials", ignored))
      if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

Material read_material(Config& section, const fs::path& folder) {
  const Config &name = section["name"], &file = section["file"];
  if (name.given && file.given) file.fail("is given beside a name", "give one of them");
  Material material;
  if (name.given) read_named(name, folder, material);
  if (file.given) {
    const fs::path place = existing_path(file, folder);
    apply(read_config(place, material_file_section()), material);
    material.name = place.stem().string();
  }
  apply(section, material);
  write_back(material, section);
  return material;
}

}  // namespace selvedge

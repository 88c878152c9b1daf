#include "pipeline/setup_springs.hpp"

#include <fmt/format.h>

#include "pipeline/config.hpp"
#include "pipeline/setup_names.hpp"
#include "pipeline/setup_pairs.hpp"

namespace selvedge {
namespace {

// Vertices of the scene, in the order in which they are listed.
std::vector<int> read_side(const Config& section, const std::vector<ClothPart>& parts, const Scene& scene) {
  if (!section["cloth"].given && parts.size() > 1) section.fail("does not say of which cloth", "name the `cloth`");
  const auto c = static_cast<std::size_t>(section["cloth"].given ? index_of(section["cloth"], parts) : 0);
  std::vector<int> vertices = read_vertices(section, parts[c]);
  for (int& v : vertices) v += scene.cloths[c].first_vertex;
  return vertices;
}

}  // namespace

std::vector<Spring> read_springs(const Config& list, const std::vector<ClothPart>& parts, const Scene& scene,
                                 const Points& x, std::vector<std::string>& warnings) {
  std::vector<Spring> springs;
  for (const Config& section : list.items) {
    const bool listed = section["pair"].text() == "listed", given = section["rest_length"].given;
    const double thickness = scene.contact.thickness;
    int shorter = 0;
    for (const auto& [a, b] :
         read_pairs(section, read_side(section["from"], parts, scene), read_side(section["to"], parts, scene), x)) {
      const double rest = given ? section["rest_length"].number() : listed ? thickness : (row(x, b) - row(x, a)).norm();
      springs.push_back({a, b, rest, section["stiffness"].number()});
      shorter += rest < thickness;
    }
    if (shorter > 0 && scene.contact.self)
      warnings.push_back(
          fmt::format("{}: {} springs are shorter at rest than contact.thickness {} m, to which contact "
                      "pushes their ends apart",
                      section.path, shorter, thickness));
  }
  return springs;
}

}  // namespace selvedge

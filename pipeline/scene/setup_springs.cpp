#include "pipeline/scene/setup_springs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "collision/geometry/counted.hpp"
#include "pipeline/obstacles/setup_pairs.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/scene/setup_selection.hpp"

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

void warn_of_short(std::span<const Spring> springs, const std::string& what, const ContactSettings& contact,
                   std::vector<std::string>& warnings) {
  const auto shorter =
      std::ranges::count_if(springs, [&](const Spring& spring) { return spring.rest_length < contact.thickness; });
  if (shorter > 0 && contact.self)
    warnings.push_back(fmt::format(
        "{}: {} shorter at rest than contact.thickness {} m, to which contact pushes {} apart", what,
        counted(shorter, "spring is", "springs are"), contact.thickness, by_number(shorter, "its ends", "their ends")));
}

// A spring that the weight of all cloth stretches by less than an atom is rigid, and solves take long.
void warn_of_stiff(std::span<const Spring> springs, const std::string& what, const Scene& scene,
                   std::vector<std::string>& warnings) {
  constexpr double atom = 1e-9, gravity = 9.81;  // [m], [m/s2]
  double most = 0;
  for (const Spring& spring : springs) most = std::max(most, spring.stiffness);
  const double weight = gravity * lumped_masses(scene).sum();
  if (most * atom > weight)
    warnings.push_back(
        fmt::format("{}: the weight of all cloth stretches a spring of {:.3g} N/m by less than {:g} m, "
                    "and solves take long; {:.0e} N/m is as good as rigid",
                    what, most, atom, 1e-3 * weight / atom));
}

std::vector<Spring> stitches_of(const Wearing& worn, int first_vertex) {
  const double scale = worn.by->section["scale"].number();
  std::vector<Spring> springs;
  for (const auto& [a, b, rest_length] : worn.garment.stitches)
    springs.push_back({first_vertex + a, first_vertex + b, scale * rest_length});
  return springs;
}

}  // namespace

std::vector<Spring> read_springs(const Config& list, const std::vector<ClothPart>& parts, const Scene& scene,
                                 const Points& x, std::vector<std::string>& warnings) {
  std::vector<Spring> all;
  const auto add = [&](std::span<const Spring> springs, const std::string& what) {
    warn_of_short(springs, what, scene.contact, warnings);
    warn_of_stiff(springs, what, scene, warnings);
    all.insert(all.end(), springs.begin(), springs.end());
  };
  for (std::size_t c = 0; c < parts.size(); ++c)
    if (parts[c].worn) add(stitches_of(*parts[c].worn, scene.cloths[c].first_vertex), "stitches of " + parts[c].name);
  for (const Config& section : list.items) {
    const bool listed = section["pair"].text() == "listed", given = section["rest_length"].given;
    const double stiffness = spring_options().read(section).stiffness;
    std::vector<Spring> springs;
    for (const auto& [a, b] :
         read_pairs(section, read_side(section["from"], parts, scene), read_side(section["to"], parts, scene), x)) {
      const double rest = given    ? section["rest_length"].number()
                          : listed ? scene.contact.thickness
                                   : (row(x, b) - row(x, a)).norm();
      springs.push_back({a, b, rest, stiffness});
    }
    add(springs, section.path);
  }
  return all;
}

}  // namespace selvedge

#include "pipeline/obstacles/setup_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "collision/geometry/box_diagonal.hpp"
#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/obstacles/setup_motion.hpp"
#include "pipeline/obstacles/setup_paths.hpp"

namespace selvedge {
namespace {

constexpr double smallest = 0.01;  // least diagonal of a cloth or a body [m]

// What brings an extent [m] nearest to a metre, by a power of ten, and the extent then: a unit that files have, if
// there is a key for it, else a scale, in the place of the one that there is.
std::string likely_cure(double extent, double scale, bool has_unit) {
  const int power = static_cast<int>(-std::round(std::log10(std::max(extent, 1e-9))));
  const double factor = std::pow(10.0, power);
  constexpr std::array units{"dm", "cm", "mm"};
  if (has_unit && power < 0 && -power <= std::ssize(units))
    return fmt::format("if its file is not in metres, say so by the key `unit` (`unit: {}` makes it {:.3g} m)",
                       units[static_cast<std::size_t>(-power - 1)], factor * extent);
  return fmt::format("if that is not its size, give it another by the key `scale` (`scale: {:g}` makes it {:.3g} m)",
                     factor * scale, factor * extent);
}

}  // namespace

Mesh read_mesh_section(const Config& section, const std::filesystem::path& folder) {
  const std::filesystem::path file = existing_path(section["file"], folder);
  Mesh mesh = read_mesh(file);
  mesh.x *= read_unit(section["unit"]);
  refuse_far(section["file"], "mesh " + file.string(), mesh.x);
  read_weld(section, file.string(), mesh);
  return mesh;
}

void read_weld(const Config& section, const std::string& name, Mesh& mesh) {
  const Config& within = section["weld_within"];
  if (section["weld"].flag())
    weld(mesh, name, within.given ? std::optional(within.number()) : std::nullopt);
  else if (within.given)
    within.fail("is given without `weld`", "write weld: true, or leave it out");
}

void refuse_far(const Config& at, const std::string& noun, const Points& x) {
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if (!(x.row(v).cwiseAbs().maxCoeff() <= largest_length))
      at.fail(fmt::format("puts vertex {} of {} at [{:.4g}, {:.4g}, {:.4g}] m", v, noun, x(v, 0), x(v, 1), x(v, 2)),
              fmt::format("correct its file, unit, `scale` or `translate`; up to {:g} m from the origin is allowed",
                          largest_length));
}

void warn_of_extent(const Config& section, const std::string& noun, double largest, bool has_unit, const Points& x,
                    const Triangles& triangles, std::vector<std::string>& warnings) {
  const double extent = box_diagonal(x(triangles.reshaped(), Eigen::all));
  if (extent <= largest && extent >= smallest) return;
  const std::string cure = likely_cure(extent, section["scale"].number(), has_unit);
  warnings.push_back(fmt::format("{} spans {:.3g} m; {}", noun, extent, cure));
}

}  // namespace selvedge

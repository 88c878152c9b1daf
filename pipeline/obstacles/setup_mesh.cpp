#include "pipeline/obstacles/setup_mesh.hpp"

#include <algorithm>
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

// The unit, a power of ten, that brings an extent [m] nearest to a metre, and the extent in it.
std::string likely_unit(double extent) {
  const double unit = std::pow(10.0, -std::round(std::log10(std::max(extent, 1e-9))));
  const std::string word = fmt::format("{:g} m", unit);
  const std::string name = word == "0.1 m" ? "dm" : word == "0.01 m" ? "cm" : word == "0.001 m" ? "mm" : word;
  return fmt::format("`unit: {}` makes it {:.3g} m", name, unit * extent);
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

void warn_of_extent(const Config& at, const std::string& noun, double largest, const Points& x,
                    std::vector<std::string>& warnings) {
  const double extent = box_diagonal(x);
  if (at["unit"].given || (extent <= largest && extent >= smallest)) return;
  warnings.push_back(fmt::format("{} spans {:.3g} m; if its file is not in metres, say so by the key `unit` ({})", noun,
                                 extent, likely_unit(extent)));
}

}  // namespace selvedge

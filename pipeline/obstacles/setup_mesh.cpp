#include "pipeline/obstacles/setup_mesh.hpp"

#include <fmt/format.h>

#include "pipeline/formats/mesh_io.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/obstacles/setup_motion.hpp"
#include "pipeline/obstacles/setup_paths.hpp"

namespace selvedge {
namespace {

constexpr double smallest = 0.01;  // least diagonal of a cloth or a body [m]

}  // namespace

Mesh read_mesh_section(const Config& section, const std::filesystem::path& folder) {
  const std::filesystem::path file = existing_path(section["file"], folder);
  Mesh mesh = read_mesh(file);
  mesh.x *= read_unit(section["unit"]);
  refuse_far(section["file"], "mesh " + file.string(), mesh.x);
  if (section["weld"].flag()) weld(mesh, file.string());
  return mesh;
}

void refuse_far(const Config& at, const std::string& noun, const Points& x) {
  for (Eigen::Index v = 0; v < x.rows(); ++v)
    if (!(x.row(v).cwiseAbs().maxCoeff() <= largest_length))
      at.fail(fmt::format("puts vertex {} of {} at [{:.4g}, {:.4g}, {:.4g}] m", v, noun, x(v, 0), x(v, 1), x(v, 2)),
              fmt::format("repair it where it was made, or give its unit; up to {:g} m from the origin is allowed",
                          largest_length));
}

void warn_of_extent(const Config& at, const std::string& noun, double largest, const Points& x,
                    std::vector<std::string>& warnings) {
  const double extent = (x.colwise().maxCoeff() - x.colwise().minCoeff()).norm();
  if (at["unit"].given || (extent <= largest && extent >= smallest)) return;
  warnings.push_back(fmt::format("{} spans {:.3g} m; if its file is not in metres, say so by the key `unit` ({})", noun,
                                 extent, extent > largest ? "unit: cm" : "unit: 10 m"));
}

}  // namespace selvedge

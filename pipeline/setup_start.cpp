#include "pipeline/setup_start.hpp"

#include <fmt/format.h>

#include "pipeline/jitter.hpp"
#include "pipeline/setup_cloth.hpp"

namespace selvedge {
namespace {

constexpr double opening = 1e-3;    // of a cloth in one point, in mean edge lengths
constexpr double one_point = 1e-9;  // extent of what counts as one, in mean edge lengths

}  // namespace

void apply_start(const Config& section, ClothPart& part, std::vector<std::string>& warnings) {
  Points& x = part.mesh.x;
  if (x.rows() == 0) return;
  const auto seed = static_cast<std::uint64_t>(section["seed"].number());
  const Vec3 stretch = section["stretch"].vector();
  const double crumple = section["crumple"].number(), edge = mean_edge_length(part.rest_triangle);
  if (stretch != Vec3::Ones()) {
    const Eigen::RowVector3d middle = 0.5 * (x.colwise().minCoeff() + x.colwise().maxCoeff());
    x = ((x.rowwise() - middle) * stretch.asDiagonal()).rowwise() + middle;
  }
  if (crumple > 0) x += crumple * random_shifts(x.rows(), seed);
  const double extent = (x.colwise().maxCoeff() - x.colwise().minCoeff()).norm();
  if (x.rows() < 2 || extent > one_point * edge) return;
  x += opening * edge * random_shifts(x.rows(), seed);
  warnings.push_back(
      fmt::format("cloth `{}` starts in one point, where no force acts: opened by random displacements of up to {:.3g} "
                  "m along each axis (seed {})",
                  part.name, opening * edge, seed));
}

}  // namespace selvedge

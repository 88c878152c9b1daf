#include "pipeline/scene/setup_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/geometry/box_diagonal.hpp"
#include "physics/recovery/cut_out.hpp"
#include "pipeline/host/bounds.hpp"
#include "pipeline/scene/config_scene.hpp"
#include "pipeline/shapes/random_shifts.hpp"

namespace selvedge {
namespace {

constexpr double opening = 1e-3;    // of a cloth in one point, in mean edge lengths
constexpr double one_point = 1e-9;  // extent of what counts as one, in mean edge lengths

// How the section has a garment start, and nothing beside it that would leave no trace.
void read_from(const Config& section, ClothPart& part) {
  const Config& from = section["from"];
  if (from.text() == "skinned") return;
  if (!part.worn) from.fail("is given for a cloth that no body wears", "make the cloth a `garment`, or leave it out");
  if (section["stretch"].vector() != Vec3::Ones() || section["crumple"].number() > 0)
    from.fail("is given beside `stretch` or `crumple`",
              "a draped start is grown clean, a cut one goes on from the skinned garment: leave these out");
  part.cut = from.text() == "cut";
  if (!part.cut) part.draping = start_options().read(section);
}

// The pose that all garments on the body were made in; the zero pose where they differ.
Points made_in(const std::vector<ClothPart>& parts, const Performance& who) {
  const Points zero = Points::Zero(static_cast<Eigen::Index>(who.body.joints.size()), 3);
  std::optional<Points> common;
  for (const ClothPart& part : parts) {
    if (!part.worn || part.worn->by.get() != &who) continue;
    const Points& own = part.worn->garment.made_in.rotations;
    const Points& made = own.rows() == 0 ? zero : own;
    if (common && *common != made) return zero;
    common = made;
  }
  return common.value_or(zero);
}

}  // namespace

int begin_draped(const Performances& bodies, double fps, std::vector<ClothPart>& parts) {
  const auto draped = std::ranges::find_if(parts, [](const ClothPart& part) { return part.draping.has_value(); });
  if (draped == parts.end()) return 0;
  const auto [seconds, hold] = *draped->draping;
  const int frames = static_cast<int>(std::ceil((seconds + hold) * fps - 1e-9));
  for (const auto& who : bodies)
    if (who) come_from(made_in(parts, *who), -frames / fps, seconds, *who);
  for (ClothPart& part : parts)
    if (part.worn) part.first = skinned_at(*part.worn, -frames / fps);
  return frames;
}

void begin_cut(const std::vector<ClothPart>& parts, const Scene& scene, State& initial) {
  std::vector<char> may(static_cast<std::size_t>(scene.surface.triangles.rows()), 0);
  bool any = false;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    if (!parts[c].cut) continue;
    any = true;
    std::fill_n(may.begin() + scene.cloths[c].first_triangle, scene.cloths[c].triangle_count, 1);
  }
  if (any) initial.cut_out = cut_out_at_start(scene, initial, may);
}

std::function<Points(double)> skinned_targets_of(const std::vector<ClothPart>& parts, const Scene& scene) {
  std::vector<std::pair<int, std::shared_ptr<const Wearing>>> worn;  // from which vertex on
  for (std::size_t c = 0; c < parts.size(); ++c)
    if (parts[c].worn) worn.emplace_back(scene.cloths[c].first_vertex, parts[c].worn);
  if (worn.empty()) return {};
  return [worn, vertices = scene.surface.vertex_count](double time) {
    Points all = Points::Constant(vertices, 3, std::numeric_limits<double>::quiet_NaN());
    for (const auto& [first, wearing] : worn)
      all.middleRows(first, wearing->garment.skin.rest.rows()) = targets_at(*wearing, time);
    return all;
  };
}

void apply_start(const Config& section, ClothPart& part, std::vector<std::string>& warnings) {
  Points& x = part.mesh.x;
  read_from(section, part);
  if (x.rows() == 0) return;
  const auto seed = static_cast<std::uint64_t>(section["seed"].number());
  const Vec3 stretch = section["stretch"].vector();
  const double before = box_diagonal(x);
  const double crumple = section["crumple"].number(), edge = mean_edge_length(part.rest_triangle);
  if (stretch != Vec3::Ones()) {
    const Eigen::RowVector3d middle = 0.5 * (x.colwise().minCoeff() + x.colwise().maxCoeff());
    x = ((x.rowwise() - middle) * stretch.asDiagonal()).rowwise() + middle;
  }
  if (crumple > 0) x += crumple * random_shifts(x.rows(), seed);
  const double extent = box_diagonal(x);
  if (!(extent <= most_start_stretch * std::max(before, edge)))
    section.fail(fmt::format("draws the cloth `{}` out from {:.3g} to {:.3g} m, and {:g} times is the most", part.name,
                             before, extent, most_start_stretch),
                 "give a smaller `stretch` or `crumple`");
  if (x.rows() < 2 || extent > one_point * edge) return;
  x += opening * edge * random_shifts(x.rows(), seed);
  warnings.push_back(
      fmt::format("cloth `{}` starts in one point, where no force acts: opened by random displacements of up to {:.3g} "
                  "m along each axis (seed {})",
                  part.name, opening * edge, seed));
}

}  // namespace selvedge

#include "pipeline/bodies/skin_places.hpp"

#include <algorithm>
#include <optional>

#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/same_places.hpp"
#include "pipeline/formats/mesh_weld.hpp"
#include "pipeline/formats/seam_places.hpp"

namespace selvedge {
namespace {

constexpr double same_weight = 1e-6;  // also of directions [m]: vertices that differ by less move alike

// Whether the directions of two vertices differ by at most `most` [m].
bool same_directions(const SkinnedSurface& skin, int v, int w, double most) {
  const auto same_rows = [&](const Eigen::MatrixXd& directions) {
    return directions.cols() == 0 ||
           (directions.middleRows(3 * v, 3) - directions.middleRows(3 * w, 3)).cwiseAbs().maxCoeff() <= most;
  };
  return v == w || (same_rows(skin.shape_directions) && same_rows(skin.pose_directions));
}

Surface surface_of(const SkinnedSurface& skin) {
  return make_surface(static_cast<int>(skin.rest.rows()), skin.triangles);
}

}  // namespace

std::vector<int> same_places(const SkinnedSurface& skin) {
  std::vector<int> places = same_places(skin.rest);
  const auto moves_alike = [&](int v, int w) {
    if (v == w) return true;
    const Eigen::RowVectorXd weights = skin.weights.row(v), others = skin.weights.row(w);
    return (weights - others).cwiseAbs().maxCoeff() <= same_weight && same_directions(skin, v, w, same_weight);
  };
  part_places(moves_alike, places);
  return places;
}

std::vector<int> seam_places(const BodyModel& body) {
  const SkinnedSurface& skin = body.skin;
  const std::vector<int> alike = same_places(skin);
  Surface surface = surface_of(skin);
  if (std::optional<WeldedSurface> welded = welded_surface(surface, alike)) surface = std::move(welded->surface);
  if (std::ranges::count(on_border(surface), 1) == 0) return alike;
  SeamPlaces seams{same_places(skin.rest), {}, std::vector<int>(alike.size(), -1)};
  seams.near = near_places(skin.rest, surface, seams.same);
  for (const auto& [places, most] :
       {std::pair(&seams.same, same_weight), {&seams.near, seam_width(skin.rest, surface)}})
    part_places([&](int v, int w) { return same_directions(skin, v, w, most); }, *places);
  for (std::size_t m = body.meshes.size(); m-- > 0;)  // the first mesh with a vertex counts
    for (const int v : body.meshes[m].second) seams.parts[v] = static_cast<int>(m);
  const std::vector<int> closed = closed_where_open(surface, seams, skin.weights).joined;
  DisjointSets sets(surface.vertex_count);
  std::vector<int> lowest;
  for (int v = 0; v < surface.vertex_count; ++v) sets.join(v, alike[v]), sets.join(v, closed[v]);
  for (int v = 0; v < surface.vertex_count; ++v) lowest.push_back(sets.root(v));
  return lowest;
}

WeldedSurface closed_surface(const BodyModel& body) {
  Surface surface = surface_of(body.skin);
  std::optional<WeldedSurface> welded = welded_surface(surface, seam_places(body));
  return welded ? *std::move(welded) : WeldedSurface{std::move(surface), {}};
}

}  // namespace selvedge

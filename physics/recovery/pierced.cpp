#include "physics/recovery/pierced.hpp"

#include <algorithm>

#include "collision/contour/find_contours.hpp"
#include "collision/untangle/separation.hpp"
#include "collision/untangle/world_sheets.hpp"

namespace selvedge {
namespace {

// How far the vertices of a side's smaller part reach from the middle of its curve, in radii of the curve.
double slenderness(const SheetView& sheet, const ContourSide& side) {
  const Points& x = *sheet.x;
  const auto from = [&](int e) { return row(x, sheet.surface->edges(e, 0)); };
  Vec3 middle = Vec3::Zero();
  for (const int e : side.edges) middle += from(e) / static_cast<double>(side.edges.size());
  double radius = 0, reach = 0;
  for (const int e : side.edges) radius = std::max(radius, (from(e) - middle).norm());
  for (const int v : side.inside) reach = std::max(reach, (row(x, v) - middle).norm());
  return radius > 0 ? reach / radius : 0;
}

bool goes_through(const WorldSheets& sheets, const Contour& contour, const std::vector<char>& inside,
                  double long_limb) {
  const ContourSide &first = contour.sides[0], &second = contour.sides[1];
  if (!contour.closed || (first.sheet == 0) == (second.sheet == 0)) return false;
  const ContourSide &cloth = first.sheet == 0 ? first : second, &body = first.sheet == 0 ? second : first;
  return body.cuts && std::ranges::all_of(cloth.inside, [&](int v) { return inside[v] != 0; }) &&
         slenderness(sheets.views[body.sheet], body) > long_limb;
}

std::vector<char> pierced_components(const ContactWorld& world, const Points& nodes, double long_limb) {
  std::vector<char> pierced(static_cast<std::size_t>(world.cloth->component_count), 0);
  const WorldSheets sheets(world, nodes);
  const std::vector<char> inside = inside_obstacles(sheets.views);
  for (const Contour& contour : find_contours(sheets.views, find_segments(sheets.views)))
    if (goes_through(sheets, contour, inside, long_limb))
      for (const ContourSide& side : contour.sides)
        if (side.sheet == 0) pierced[side.component] = 1;
  return pierced;
}

// Components with more than `part` of their vertices tangled with obstacles and farther than `min_distance` from
// targets.
std::vector<char> far_components(const ContactWorld& world, const Exemption& exemption, const Points& nodes,
                                 const Points& targets, double part, double min_distance) {
  const auto components = static_cast<std::size_t>(world.cloth->component_count);
  std::vector<int> size(components, 0), far(components, 0);
  for (int v = 0; v < targets.rows(); ++v) {
    const int component = world.cloth->component[v];
    ++size[component];
    far[component] += exemption.body[v] && (targets.row(v) - nodes.row(v)).norm() > min_distance;
  }
  std::vector<char> found(components, 0);
  for (std::size_t c = 0; c < components; ++c) found[c] = far[c] > part * size[c];
  return found;
}

bool applies(const Exemption& exemption, const Points& targets) {
  return !exemption.body.empty() && exemption.switched_off.empty() && targets.rows() > 0;
}

// Removes components with a vertex that no body wears, which has no target.
void leave_undressed(const ContactWorld& world, const Points& targets, std::vector<char>& components) {
  for (int v = 0; v < targets.rows(); ++v)
    if (!targets.row(v).allFinite()) components[world.cloth->component[v]] = 0;
}

// 1 for vertices of marked components; empty if there are none.
std::vector<char> vertices_of(const ContactWorld& world, const std::vector<char>& components) {
  if (std::ranges::find(components, 1) == components.end()) return {};
  std::vector<char> vertices;
  for (const int component : world.cloth->component) vertices.push_back(components[component]);
  return vertices;
}

}  // namespace

std::vector<char> sunken_vertices(const ContactWorld& world, const Exemption& exemption, const Points& targets,
                                  const RecoveryOptions& options) {
  if (!applies(exemption, targets)) return {};
  std::vector<char> sunken =
      far_components(world, exemption, Points::Zero(targets.rows(), 3), targets, options.sunken_part, -1);
  leave_undressed(world, targets, sunken);
  return vertices_of(world, sunken);
}

std::vector<char> pierced_vertices(const ContactWorld& world, const Exemption& exemption, const Points& nodes,
                                   const Points& wanted, const Points& targets, double min_distance,
                                   const RecoveryOptions& options) {
  if (!applies(exemption, targets)) return {};
  std::vector<char> pierced =
      either(pierced_components(world, nodes, options.long_limb),
             far_components(world, exemption, nodes, targets, options.pierced_part, min_distance));
  if (pierced.empty()) return {};
  leave_undressed(world, targets, pierced);
  Points there = wanted;
  for (int v = 0; v < targets.rows(); ++v) there.row(v) = targets.row(v).allFinite() ? targets.row(v) : nodes.row(v);
  const std::vector<char> anyway = pierced_components(world, there, options.long_limb);
  for (std::size_t c = 0; c < pierced.size(); ++c) pierced[c] = pierced[c] && !anyway[c];
  return vertices_of(world, pierced);
}

}  // namespace selvedge

#include "collision/untangle/remainder.hpp"

#include <algorithm>
#include <cmath>

#include "collision/contour/contour_translation.hpp"

namespace selvedge {
namespace {

std::string name_of(const ContourSide& side) {
  return (side.sheet == 0 ? "piece " : "body " + std::to_string(side.sheet - 1) + ", piece ") +
         std::to_string(side.component);
}

// What stopped the cloth round the contour: the limits on its triangles' stretch, or on the motion of vertices away
// from contours.
std::string held_by(std::span<const SheetView> sheets, const Contour& contour, const InputShape& shape,
                    const std::vector<double>& reach, const StretchRange& range) {
  const Surface& cloth = *sheets[0].surface;
  const Points& x = *sheets[0].x;
  std::vector<char> marked(cloth.vertex_count, 0);
  for (const ContourSide& side : contour.sides)
    if (side.sheet == 0)
      for (int t : side.triangles)
        for (int v : cloth.triangles.row(t)) marked[v] = 1;
  const std::vector<char> near = within_rings(shape, marked, 2);
  bool far = false, stretched = false;
  for (int v = 0; v < cloth.vertex_count; ++v)
    far = far || (near[v] && std::isfinite(reach[v]) && (x.row(v) - shape.x0.row(v)).norm() >= 0.95 * reach[v]);
  for (int t = 0; t < cloth.triangles.rows(); ++t) {
    if (!near[cloth.triangles(t, 0)] && !near[cloth.triangles(t, 1)] && !near[cloth.triangles(t, 2)]) continue;
    const StretchRange stretch = stretch_of(shape, x, t);
    stretched = stretched || stretch.least < 1.05 * range.least || stretch.largest > 0.95 * range.largest;
  }
  if (stretched) return "the triangles round it are stretched or pressed as far as they may be";
  if (far) return "the cloth round it would have to move beyond the rings that may";
  return "";
}

std::string reason_of(std::span<const SheetView> sheets, const Segments& found, const Contour& contour,
                      const InputShape& shape, const std::vector<double>& reach, const StretchRange& range) {
  const ContourSide &a = contour.sides[0], &b = contour.sides[1];
  std::string text = (contour.closed ? "closed, " : "open, ") + name_of(a) + " with ";
  text += a.sheet == b.sheet && a.component == b.component ? "itself" : name_of(b);
  const std::string held = held_by(sheets, contour, shape, reach, range);
  if (!held.empty()) return text + ": " + held;
  if (!a.cuts && !b.cuts) {
    if (contour_translation(sheets, found, contour).mean.norm() < 0.1)
      return text + ": encloses nothing, and no direction shortens it";
    return text + ": encloses nothing, and got no shorter";
  }
  if (a.cuts && b.cuts && contour.closed && a.inside.size() > 200 && b.inside.size() > 200)
    return text + ": one passes right through the other, with no near way out";
  return text + ": got no shorter";
}

}  // namespace

std::vector<Remainder> explain_remainders(std::span<const SheetView> sheets, const Segments& found,
                                          std::span<const Contour> contours, const InputShape& shape,
                                          const std::vector<double>& reach, const StretchRange& range) {
  std::vector<Remainder> remainders;
  for (const Contour& contour : contours) {
    Remainder left{0, contour.length, reason_of(sheets, found, contour, shape, reach, range)};
    for (int s : contour.segments) left.pairs += !found.segments[s].at_vertex();
    remainders.push_back(std::move(left));
  }
  if (!found.touching.empty()) {
    Remainder& touching = remainders.emplace_back();
    touching.pairs = static_cast<int>(found.touching.size());
    touching.reason = "triangles that touch without crossing";
  }
  return remainders;
}

}  // namespace selvedge

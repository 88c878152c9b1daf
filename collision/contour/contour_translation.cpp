#include "collision/contour/contour_translation.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

// Longer slides are left out: the edge is so nearly parallel to the face that its slide says little of the contour.
constexpr double longest_slide = 4;

Vec3 position(std::span<const SheetView> sheets, const Segments& found, const Contour& contour, std::size_t i) {
  const int point = contour.points[i];
  const Segment& any = found.segments[contour.segments.front()];
  return point < 0 ? row(*sheets[any.sheet[0]].x, ~point) : point_of(sheets, found.crossings[point]);
}

// Sum of the unit vectors from point i toward its neighbours: minus the derivative of the length by the point.
Vec3 tension(const std::vector<Vec3>& at, bool closed, std::size_t i) {
  const std::size_t n = at.size();
  Vec3 sum = Vec3::Zero();
  const auto add = [&](std::size_t j) {
    const Vec3 to = at[j] - at[i];
    const double length = to.norm();
    if (length > 0) sum += to / length;
  };
  if (closed || i > 0) add((i + n - 1) % n);
  if (closed || i + 1 < n) add((i + 1) % n);
  return sum;
}

// Motion of the edge against the face that slides the crossing along the edge as the tension pulls it.
Vec3 slide(std::span<const SheetView> sheets, const Crossing& c, const Vec3& tension) {
  const Surface &of_edge = *sheets[c.edge_sheet].surface, &of_face = *sheets[c.face_sheet].surface;
  const Points &x = *sheets[c.edge_sheet].x, &y = *sheets[c.face_sheet].x;
  const Vec3 along = row(x, of_edge.edges(c.edge, 1)) - row(x, of_edge.edges(c.edge, 0));
  const Vec3 d0 = row(y, of_face.triangles(c.face, 0)), d1 = row(y, of_face.triangles(c.face, 1));
  const Vec3 normal = (d1 - d0).cross(row(y, of_face.triangles(c.face, 2)) - d0).normalized();
  const double slope = normal.dot(along);
  const double size = -tension.dot(along) / slope;
  return std::isfinite(size) ? Vec3(std::clamp(size, -longest_slide, longest_slide) * normal) : Vec3::Zero();
}

}  // namespace

ContourTranslation contour_translation(std::span<const SheetView> sheets, const Segments& found,
                                       const Contour& contour) {
  const std::size_t n = contour.points.size();
  std::vector<Vec3> at(n), own(n, Vec3::Zero());
  for (std::size_t i = 0; i < n; ++i) at[i] = position(sheets, found, contour, i);
  ContourTranslation result;
  double size = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const int point = contour.points[i];
    if (point < 0) continue;
    const int side = contour.point_side[i];
    const Vec3 moved = slide(sheets, found.crossings[point], tension(at, contour.closed, i));
    own[i] = side == 0 ? moved : Vec3(-moved);
    result.mean += own[i];
    size += own[i].norm();
  }
  if (size > 0) result.mean /= size;
  constexpr int reach = 3;
  result.local.assign(n, Vec3::Zero());
  for (int i = 0; i < static_cast<int>(n); ++i)
    for (int j = i - reach; j <= i + reach; ++j) {
      const int wrapped = (j % static_cast<int>(n) + static_cast<int>(n)) % static_cast<int>(n);
      if (contour.points[i] >= 0 && (contour.closed || wrapped == j)) result.local[i] += own[wrapped];
    }
  return result;
}

}  // namespace selvedge

#include "collision/penetration/face_cells.hpp"

#include <algorithm>

namespace selvedge {
namespace {

using Polygon = std::vector<Vec2>;

// Does the chord run through the inside of a convex polygon?
bool runs_through(const Polygon& polygon, const FaceChord& chord) {
  double first = 0, last = 1;
  const Vec2 along = chord.to - chord.from;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &p = polygon[i], side = polygon[(i + 1) % polygon.size()] - p;
    const double height = cross(side, chord.from - p), rise = cross(side, along);
    if (rise > 0)
      first = std::max(first, -height / rise);
    else if (rise < 0)
      last = std::min(last, -height / rise);
    else if (height <= 0)
      return false;
  }
  return last - first > 1e-12;
}

// The polygon's parts on the left and on the right of the line through the chord.
std::array<Polygon, 2> split_along(const Polygon& polygon, const FaceChord& chord) {
  std::array<Polygon, 2> parts;
  const Vec2 along = chord.to - chord.from;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double hp = cross(along, p - chord.from), hq = cross(along, q - chord.from);
    if (hp >= 0) parts[0].push_back(p);
    if (hp <= 0) parts[1].push_back(p);
    if ((hp > 0) != (hq > 0) && hp != 0 && hq != 0)
      for (Polygon& part : parts) part.push_back(p + (q - p) * (hp / (hp - hq)));
  }
  return parts;
}

FaceCell measured(Polygon polygon) {
  FaceCell cell;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vec2 &a = polygon[0], &b = polygon[i], &c = polygon[i + 1];
    const double area = 0.5 * cross(b - a, c - a);
    const Vec2 mean = (a + b + c) / 3;
    cell.moment[0] += area * (1 - mean.sum());
    cell.moment[1] += area * mean.x();
    cell.moment[2] += area * mean.y();
  }
  const double area = cell.moment[0] + cell.moment[1] + cell.moment[2];
  if (area > 0)
    for (int k = 0; k < 3; ++k) cell.middle[k] = cell.moment[k] / area;
  std::array<int, 3> on_edge{};
  for (const Vec2& p : polygon) {
    on_edge[0] += std::abs(p.y()) < 1e-12;
    on_edge[1] += std::abs(1 - p.sum()) < 1e-12;
    on_edge[2] += std::abs(p.x()) < 1e-12;
  }
  for (int k = 0; k < 3; ++k) cell.at_edge[k] = on_edge[k] > 1;
  cell.corners = std::move(polygon);
  return cell;
}

}  // namespace

std::vector<FaceCell> face_cells(std::span<const FaceChord> chords) {
  std::vector<Polygon> polygons{{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}};
  for (const FaceChord& chord : chords) {
    std::vector<Polygon> finer;
    for (Polygon& polygon : polygons) {
      if (!runs_through(polygon, chord)) {
        finer.push_back(std::move(polygon));
        continue;
      }
      for (Polygon& part : split_along(polygon, chord))
        if (part.size() > 2) finer.push_back(std::move(part));
    }
    polygons.swap(finer);
  }
  std::vector<FaceCell> cells;
  for (Polygon& polygon : polygons) {
    FaceCell cell = measured(std::move(polygon));
    if (cell.moment[0] + cell.moment[1] + cell.moment[2] > 1e-14) cells.push_back(std::move(cell));
  }
  return cells;
}

}  // namespace selvedge

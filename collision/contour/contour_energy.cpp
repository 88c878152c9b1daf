#include "collision/contour/contour_energy.hpp"

#include <cmath>
#include <optional>

namespace selvedge {
namespace {

// The end of a segment with the values that its derivative needs.
struct EndPoint {
  Vec3 at = Vec3::Zero();
  int edge_sheet = 0, face_sheet = 0;
  std::array<int, 2> edge{-1, -1};  // at a loop vertex: this vertex, then -1
  std::array<int, 3> face{};
  Vec3 a = Vec3::Zero(), b = Vec3::Zero(), normal = Vec3::Zero();  // the normal is not of unit length
  double s = 0, slope = 0;                                         // n.(B - A)
  std::array<double, 3> weight{};
};

std::optional<EndPoint> crossing_point(std::span<const SheetView> sheets, const Crossing& c) {
  EndPoint p;
  p.edge_sheet = c.edge_sheet;
  p.face_sheet = c.face_sheet;
  const Surface &of_edge = *sheets[c.edge_sheet].surface, &of_face = *sheets[c.face_sheet].surface;
  const Points &x = *sheets[c.edge_sheet].x, &y = *sheets[c.face_sheet].x;
  p.edge = {of_edge.edges(c.edge, 0), of_edge.edges(c.edge, 1)};
  p.a = row(x, p.edge[0]);
  p.b = row(x, p.edge[1]);
  for (int k = 0; k < 3; ++k) p.face[k] = of_face.triangles(c.face, k);
  const Vec3 d0 = row(y, p.face[0]), d1 = row(y, p.face[1]), d2 = row(y, p.face[2]);
  p.normal = (d1 - d0).cross(d2 - d0);
  p.slope = p.normal.dot(p.b - p.a);
  p.s = p.normal.dot(d0 - p.a) / p.slope;
  p.at = p.a + p.s * (p.b - p.a);
  const double square = p.normal.squaredNorm();
  p.weight = {p.normal.dot((d2 - d1).cross(p.at - d1)) / square, p.normal.dot((d0 - d2).cross(p.at - d2)) / square, 0};
  p.weight[2] = 1 - p.weight[0] - p.weight[1];
  const bool defined = p.at.allFinite() && std::isfinite(p.weight[0]) && std::isfinite(p.weight[1]);
  return defined ? std::optional(p) : std::nullopt;
}

std::optional<EndPoint> end_of(std::span<const SheetView> sheets, const Segments& found, const Segment& segment,
                               int end) {
  const int at = segment.end[end];
  if (at >= 0) return crossing_point(sheets, found.crossings[at]);
  EndPoint p;
  p.edge_sheet = segment.sheet[0];
  p.edge = {~at, -1};
  p.at = row(*sheets[segment.sheet[0]].x, ~at);
  return p;
}

// `pull` is the derivative by the end point.
void add_gradient(const EndPoint& p, const Vec3& pull, ContourGradient kind, ContourNormal normal,
                  std::vector<Points>& gradient) {
  Points& by_edge = gradient[p.edge_sheet];
  const bool full = kind == ContourGradient::full;
  if (p.edge[1] < 0) {
    if (full) by_edge.row(p.edge[0]) += pull.transpose();
    return;
  }
  // Because the normal turns with the face, weights are those of the crossing; with a frozen normal they are a third
  // each.
  const Vec3 sliding = pull.dot(p.b - p.a) / p.slope * p.normal;
  by_edge.row(p.edge[0]) -= (1 - p.s) * sliding.transpose();
  by_edge.row(p.edge[1]) -= p.s * sliding.transpose();
  const bool frozen = normal == ContourNormal::frozen;
  for (int k = 0; k < 3; ++k)
    gradient[p.face_sheet].row(p.face[k]) += (frozen ? 1.0 / 3 : p.weight[k]) * sliding.transpose();
  if (!full) return;
  by_edge.row(p.edge[0]) += (1 - p.s) * pull.transpose();
  by_edge.row(p.edge[1]) += p.s * pull.transpose();
}

}  // namespace

double contour_energy(std::span<const SheetView> sheets, const Segments& segments, ContourMeasure measure,
                      std::vector<Points>* gradient, ContourGradient kind, ContourNormal normal) {
  if (gradient) {
    gradient->clear();
    for (const SheetView& sheet : sheets) gradient->push_back(Points::Zero(sheet.surface->vertex_count, 3));
  }
  double value = 0;
  for (const Segment& segment : segments.segments) {
    const std::optional<EndPoint> first = end_of(sheets, segments, segment, 0);
    const std::optional<EndPoint> second = end_of(sheets, segments, segment, 1);
    if (!first || !second) continue;
    const Vec3 along = first->at - second->at;
    const double length = along.norm();
    const bool squared = measure == ContourMeasure::squared_length;
    value += squared ? length * length : length;
    if (!gradient || length == 0) continue;
    const Vec3 pull = squared ? Vec3(2 * along) : Vec3(along / length);
    add_gradient(*first, pull, kind, normal, *gradient);
    add_gradient(*second, -pull, kind, normal, *gradient);
  }
  return value;
}

}  // namespace selvedge

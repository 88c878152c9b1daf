#include "collision/penetration/open_contours.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace selvedge {
namespace {

// A place on the rim of a closed hole.
struct RimPlace {
  int loop = -1, place = 0;  // the edge from vertex `place` of the loop to the next; -1: no rim
};

int first_fan(const ClosedSurface& closed, int loop) {
  int first = closed.cloth_triangles;
  for (int l = 0; l < loop; ++l) first += static_cast<int>(closed.loops[l].size());
  return first;
}

RimPlace rim_place(const ClosedSurface& closed, int edge) {
  for (const int t : closed.surface.edge_triangles[edge])
    if (t >= 0 && closed.is_fan(t)) {
      const int loop = closed.surface.triangles(t, 2) - closed.cloth_vertices;
      return {loop, t - first_fan(closed, loop)};
    }
  return {};
}

double length_along(const ClosedSurface& closed, const Points& x, const std::vector<Crossing>& crossings,
                    const std::vector<CurvePoint>& points) {
  double length = 0;
  for (std::size_t k = 1; k < points.size(); ++k)
    length += (position_of(closed.surface, x, crossings, points[k]) -
               position_of(closed.surface, x, crossings, points[k - 1]))
                  .norm();
  return length;
}

// The edge between two corners of a triangle.
int edge_between(const Surface& surface, int triangle, int a, int b) {
  const int i = surface.corner_of(triangle, a), j = surface.corner_of(triangle, b);
  return surface.triangle_edges(triangle, j == (i + 1) % 3 ? i : j);
}

// The path round a hole from one crossing of its rim to another, forward or backward in the order of the loop.
std::vector<CurvePoint> round_hole(const std::vector<int>& loop, CurvePoint from, int at, CurvePoint to, int last,
                                   bool forward) {
  const int n = static_cast<int>(loop.size());
  std::vector<CurvePoint> points{from};
  for (; at != last; at = (at + (forward ? 1 : n - 1)) % n) points.push_back(~loop[forward ? (at + 1) % n : at]);
  points.push_back(to);
  return points;
}

class Closer {
 public:
  Closer(const ClosedSurface& closed, const Points& x, const Contour& contour, std::vector<Crossing>& crossings)
      : closed_(closed), surface_(closed.surface), x_(x), contour_(contour), crossings_(crossings) {}

  // The rims' places at the contour's last and first point.
  std::array<RimPlace, 2> rims() const { return {rim_of(from()), rim_of(to())}; }

  // Along the rim on its inside, through the triangles of the fan.
  void go_along_rim(const std::array<RimPlace, 2>& rims, SurfaceCurve& curve, ContourClosing::Path& path) {
    const std::vector<int>& loop = closed_.loops[rims[0].loop];
    const int n = static_cast<int>(loop.size()), first = first_fan(closed_, rims[0].loop);
    path.points = round_hole(loop, from(), rims[0].place, to(), rims[1].place, true);
    std::vector<CurvePoint> back = round_hole(loop, from(), rims[0].place, to(), rims[1].place, false);
    const bool forward =
        length_along(closed_, x_, crossings_, path.points) <= length_along(closed_, x_, crossings_, back);
    if (!forward) path.points.swap(back);
    int fan = first + rims[0].place;
    cut(curve, path.end_faces[0], crossings_[from()].edge, from());
    for (std::size_t k = 0; k + 1 < path.points.size(); ++k) {
      const CurvePoint at = path.points[k], next = path.points[k + 1];
      curve.runs.push_back({fan, at, next});
      if (next < 0) cut(curve, fan, edge_between(surface_, fan, ~next, surface_.triangles(fan, 2)), next);
      if (next >= 0) break;
      fan = first + (fan - first + (forward ? 1 : n - 1)) % n;
    }
    cut(curve, fan, crossings_[to()].edge, to());
  }

  // False if the path meets a hole or is too long.
  bool go_straight(const Vec3& up, SurfaceCurve& curve, ContourClosing::Path& path) {
    path.points = {from()};
    const Vec3 p = at(to()), toward = p - at(from());
    const Vec3 normal = toward.cross(up);
    const auto height = [&](int vertex) { return normal.dot(row(x_, vertex) - p); };
    int face = path.end_faces[0], last = -1;
    const std::size_t most = 4 * contour_.segments.size() + 100;
    while (face != path.end_faces[1]) {
      int chosen = -1;
      double share = 0, farthest = 0;
      for (int k = 0; k < 3; ++k) {
        const int edge = surface_.triangle_edges(face, k), a = surface_.edges(edge, 0), b = surface_.edges(edge, 1);
        const double low = height(a), high = height(b);
        if (edge == last || (low < 0) == (high < 0)) continue;
        const double s = low / (low - high);
        const double ahead = toward.dot((1 - s) * row(x_, a) + s * row(x_, b));
        if (chosen >= 0 && ahead <= farthest) continue;
        chosen = edge;
        share = s;
        farthest = ahead;
      }
      if (chosen < 0 || path.points.size() > most) return false;
      leave(face, chosen, share, curve, path);
      face = surface_.across(chosen, face);
      if (face < 0 || closed_.is_fan(face)) return false;
      last = chosen;
    }
    curve.runs.push_back({face, path.points.back(), to()});
    path.points.push_back(to());
    return length_along(closed_, x_, crossings_, path.points) <= 2 * contour_.length;
  }

  void go_through_middles(SurfaceCurve& curve, ContourClosing::Path& path) {
    path.points = {from()};
    for (const StripStep& step : shortest_strip(path.end_faces[0], path.end_faces[1]))
      leave(step.face, step.edge, 0.5, curve, path);
    curve.runs.push_back({path.end_faces[1], path.points.back(), to()});
    path.points.push_back(to());
  }

 private:
  struct StripStep {
    int face = 0, edge = 0;  // the face that is left, and through which edge
    int before = -1;         // index of the step before
  };

  // The shortest path over the cloth's faces through the middles of edges (Dijkstra).
  std::vector<StripStep> shortest_strip(int first, int last) const {
    std::vector<StripStep> steps, strip;
    std::set<std::tuple<double, int, int>> front;  // length of the path, edge, index of the step
    std::vector<char> crossed(static_cast<std::size_t>(surface_.edges.rows()), 0);
    const auto spread = [&](const Vec3& from, double length, int face, int before) {
      for (int k = 0; k < 3; ++k) {
        const int edge = surface_.triangle_edges(face, k);
        if (crossed[edge]) continue;
        front.emplace(length + (middle(edge) - from).norm(), edge, static_cast<int>(steps.size()));
        steps.push_back({face, edge, before});
      }
    };
    int reached = -1;
    if (first != last) spread(at(from()), 0, first, -1);
    while (!front.empty() && reached < 0) {
      const auto [length, edge, place] = *front.begin();
      front.erase(front.begin());
      if (crossed[edge]) continue;
      crossed[edge] = 1;
      const int next = surface_.across(edge, steps[place].face);
      if (next == last) reached = place;
      if (next >= 0 && !closed_.is_fan(next)) spread(middle(edge), length, next, place);
    }
    for (; reached >= 0; reached = steps[reached].before) strip.push_back(steps[reached]);
    std::ranges::reverse(strip);
    return strip;
  }

  Vec3 middle(int edge) const { return (row(x_, surface_.edges(edge, 0)) + row(x_, surface_.edges(edge, 1))) / 2; }

  // Continues the path to a point on an edge of the face, and into the next face.
  void leave(int face, int edge, double share, SurfaceCurve& curve, ContourClosing::Path& path) {
    const int id = static_cast<int>(crossings_.size());
    crossings_.push_back({0, edge, 0, -1, share, {}});
    curve.runs.push_back({face, path.points.back(), id});
    cut(curve, face, edge, id);
    path.points.push_back(id);
  }

  CurvePoint from() const { return contour_.points.back(); }
  CurvePoint to() const { return contour_.points.front(); }
  RimPlace rim_of(CurvePoint point) const { return rim_place(closed_, crossings_[point].edge); }
  Vec3 at(CurvePoint point) const { return position_of(surface_, x_, crossings_, point); }
  void cut(SurfaceCurve& curve, int leaving, int edge, CurvePoint point) const {
    curve.cuts.push_back({edge, point, jump_on_leaving(closed_, leaving, edge)});
  }

  const ClosedSurface& closed_;
  const Surface& surface_;
  const Points& x_;
  const Contour& contour_;
  std::vector<Crossing>& crossings_;
};

}  // namespace

std::optional<ContourClosing> close_open_contour(const ClosedSurface& closed, const Points& x, const Contour& contour,
                                                 int number, std::vector<Crossing>& crossings,
                                                 std::vector<SurfaceCurve>& curves) {
  if (contour.closed || contour.ends != std::array{ContourEnd::boundary, ContourEnd::boundary}) return std::nullopt;
  for (const ContourSide& side : contour.sides)
    if (!closed.orientable[side.component]) return std::nullopt;
  Closer closer(closed, x, contour, crossings);
  const std::array<RimPlace, 2> rims = closer.rims();
  if (rims[0].loop < 0 || rims[1].loop < 0) return std::nullopt;
  const bool one_rim = rims[0].loop == rims[1].loop;
  if (!one_rim && contour.end_side[0] == contour.end_side[1]) return std::nullopt;
  ContourClosing closing;
  const std::size_t before = crossings.size();
  std::array<SurfaceCurve, 2> made;
  const auto close = [&](ClosingKind kind) {
    crossings.resize(before);
    for (int side = 0; side < 2; ++side) {
      const std::vector<int>& triangles = contour.sides[side].triangles;
      const bool at_rim = one_rim && side == contour.end_side[0];
      closing.paths[side] = {
          at_rim ? ClosingKind::rim : kind, {}, {triangles.back(), triangles.front()}, side == 0 ? -1 : 1};
      made[side] = curve_on_side(closed, crossings, contour, number, side);
    }
    const Vec3 up = up_of_plane(closed, x, closing);
    bool goes = true;
    for (int side = 0; side < 2; ++side) {
      ContourClosing::Path& path = closing.paths[side];
      if (path.kind == ClosingKind::rim) closer.go_along_rim(rims, made[side], path);
      if (path.kind == ClosingKind::plane) goes &= closer.go_straight(up, made[side], path);
      if (path.kind == ClosingKind::middles) closer.go_through_middles(made[side], path);
    }
    return goes;
  };
  if (!close(ClosingKind::plane)) close(ClosingKind::middles);
  std::ranges::move(made, std::back_inserter(curves));
  return closing;
}

}  // namespace selvedge

#include "collision/penetration/surface_curve.hpp"

#include <algorithm>

namespace selvedge {
namespace {

// Leads the curve round the loop vertex at which it turns from one side of the contour to the other, in the direction
// with fewer edges.
bool pass_vertex(const ClosedSurface& closed, int vertex, int from, int to, SurfaceCurve& curve) {
  const auto forward = edges_round(closed.surface, vertex, from, to, true),
             back = edges_round(closed.surface, vertex, from, to, false);
  if (!forward && !back) return false;
  const auto& edges = forward && (!back || forward->size() <= back->size()) ? *forward : *back;
  for (const auto& [edge, triangle] : edges) {
    curve.cuts.push_back({edge, ~vertex, jump_on_leaving(closed, triangle, edge)});
    curve.passed.push_back(triangle);
  }
  curve.passed.push_back(to);
  return true;
}

// Appends the contour's curve on one of its sides.
void add_side(const ClosedSurface& closed, const std::vector<Crossing>& crossings, const Contour& contour, int side,
              bool backwards, SurfaceCurve& curve) {
  const int segments = static_cast<int>(contour.segments.size()), points = static_cast<int>(contour.points.size());
  const ContourSide& on = contour.sides[side];
  for (int i = 0; i < segments; ++i) {
    const CurvePoint from = contour.points[i], to = contour.points[(i + 1) % points];
    curve.runs.push_back({on.triangles[i], backwards ? to : from, backwards ? from : to});
  }
  for (int i = 0; i < points; ++i) {
    const bool at_end = !contour.closed && (i == 0 || i + 1 == points);
    if (at_end || contour.point_side[i] != side) continue;
    const int edge = crossings[contour.points[i]].edge, left = on.triangles[(i + segments - 1) % segments];
    const int jump = jump_on_leaving(closed, left, edge);
    curve.cuts.push_back({edge, contour.points[i], backwards ? -jump : jump});
  }
}

bool ends_at_vertices(const Contour& contour) {
  return contour.ends[0] == ContourEnd::vertex && contour.ends[1] == ContourEnd::vertex;
}

}  // namespace

int jump_on_leaving(const ClosedSurface& closed, int triangle, int edge) {
  const Surface& surface = closed.surface;
  const int k = surface.side_of(triangle, edge);
  const bool rises = surface.triangles(triangle, k) < surface.triangles(triangle, (k + 1) % 3);
  return (rises ? 1 : -1) * closed.turn[triangle];
}

SurfaceCurve curve_on_side(const ClosedSurface& closed, const std::vector<Crossing>& crossings, const Contour& contour,
                           int number, int side) {
  SurfaceCurve curve{number, contour.sides[side].component, side, {}, {}, {}};
  add_side(closed, crossings, contour, side, false, curve);
  return curve;
}

CurveFailure add_curves(const ClosedSurface& closed, const std::vector<Crossing>& crossings, const Contour& contour,
                        int number, std::vector<SurfaceCurve>& curves) {
  const bool loop = !contour.closed && ends_at_vertices(contour);
  if (!contour.closed && !loop) return CurveFailure::open;
  for (const ContourSide& side : contour.sides)
    if (!closed.orientable[side.component]) return CurveFailure::not_orientable;
  if (contour.one_trace) return CurveFailure::not_orientable;
  if (!loop) {
    for (int side = 0; side < 2; ++side) curves.push_back(curve_on_side(closed, crossings, contour, number, side));
    return CurveFailure::none;
  }
  SurfaceCurve curve{number, contour.sides[0].component, 0, {}, {}, {}};
  const ContourSide &there = contour.sides[0], &back = contour.sides[1];
  add_side(closed, crossings, contour, 0, false, curve);
  add_side(closed, crossings, contour, 1, true, curve);
  if (!pass_vertex(closed, ~contour.points.back(), there.triangles.back(), back.triangles.back(), curve) ||
      !pass_vertex(closed, ~contour.points.front(), back.triangles.front(), there.triangles.front(), curve))
    return CurveFailure::open;
  curves.push_back(std::move(curve));
  return CurveFailure::none;
}

}  // namespace selvedge

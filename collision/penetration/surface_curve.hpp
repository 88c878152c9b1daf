#pragma once

#include <vector>

#include "collision/contour/contour.hpp"
#include "collision/penetration/closed_surface.hpp"

namespace selvedge {

// An end of a piece of a curve: a crossing, or the bitwise complement of a vertex, as Segment::end.
using CurvePoint = int;

// Where a curve crosses an edge. `jump` is +1 if the edge, from its lower to its higher vertex, leads from the curve's
// right to its left, seen from outside (triangles turned by ClosedSurface::turn).
struct CurveCut {
  int edge = 0;
  CurvePoint at = 0;
  int jump = 0;
};

// A piece of the curve inside a face.
struct CurveRun {
  int face = 0;
  CurvePoint from = 0, to = 0;
};

// A closed curve on one component: a contour's curve on one of its sides. If both ends are loop vertices it runs along
// one side and back along the other. Round a loop vertex it crosses the edges at that vertex.
struct SurfaceCurve {
  int contour = 0, component = 0;
  int side = 0;  // of the contour; signs on sides 0 and 1 are opposite
  std::vector<CurveCut> cuts;
  std::vector<CurveRun> runs;
  std::vector<int> passed;  // faces round loop vertices that it touches only at the vertex
};

// Why a contour yields no curve that could bound a part of the surface.
enum class CurveFailure { none, open, not_orientable };

// Appends the curves of a contour: one or two; none where it fails. `number` is the contour's number.
CurveFailure add_curves(const ClosedSurface&, const std::vector<Crossing>&, const Contour&, int number,
                        std::vector<SurfaceCurve>& curves);

// A contour's curve on one of its sides. For an open contour it stops at the ends.
SurfaceCurve curve_on_side(const ClosedSurface&, const std::vector<Crossing>&, const Contour&, int number, int side);

// CurveCut::jump of a curve that leaves a triangle through an edge. The edge, in the triangle's order of corners, leads
// to the curve's left.
int jump_on_leaving(const ClosedSurface&, int triangle, int edge);

}  // namespace selvedge

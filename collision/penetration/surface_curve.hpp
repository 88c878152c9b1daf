#pragma once

#include <span>
#include <vector>

#include "collision/contour/contour.hpp"
#include "collision/penetration/closed_surface.hpp"

namespace selvedge {

// An end of a piece of a curve: a crossing, or the bitwise complement of a vertex, as Segment::end.
using CurvePoint = int;

// Where a curve crosses an edge. From the edge's lower vertex to the higher one `jump` is +1 if it leads from the
// curve's right to its left, seen on the side that the triangles' turns show.
struct CurveCut {
  int edge = 0;
  CurvePoint at = 0;
  int jump = 0;
};

// The curve inside a face.
struct CurveRun {
  int face = 0;
  CurvePoint from = 0, to = 0;
};

// A closed curve on one component: what a contour is on one of its sides, or, with loop vertices at both ends, on both,
// the second side backwards. Round a loop vertex it passes through edges at that vertex.
struct SurfaceCurve {
  int contour = 0, component = 0;
  int side = 0;  // of the contour: 1 runs against what cancels it
  std::vector<CurveCut> cuts;
  std::vector<CurveRun> runs;
  std::vector<int> passed;  // faces round loop vertices that it only passes through at the vertex
};

// Why a contour makes no curve that could bound a part of the surface.
enum class CurveFailure { none, open, not_orientable };

// The curves of a contour: one or two. Appends nothing where it fails.
CurveFailure add_curves(const ClosedSurface&, const std::vector<Crossing>&, const Contour&, int number,
                        std::vector<SurfaceCurve>& curves);

// What a contour is on one of its sides; of an open one without what happens at its ends.
SurfaceCurve curve_on_side(const ClosedSurface&, const std::vector<Crossing>&, const Contour&, int number, int side);

// CurveCut::jump of a way that leaves a triangle through an edge: the edge's end in the triangle's sense of rotation is
// on its left.
int jump_on_leaving(const ClosedSurface&, int triangle, int edge);

}  // namespace selvedge

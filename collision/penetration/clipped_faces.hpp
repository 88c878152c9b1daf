#pragma once

#include <array>
#include <utility>
#include <vector>

#include "collision/penetration/surface_curve.hpp"

namespace selvedge {

// Parts of a face, each with an integer: how often it counts. moment[k] is the integral over the face of this integer
// times the k-th barycentric coordinate, where the face's area is taken as 1/2.
struct ClippedFace {
  int face = 0;
  bool whole = false;  // no curve runs through it
  std::array<double, 3> moment{};
  double covered() const { return moment[0] + moment[1] + moment[2]; }
};

// A piece of the boundary of a part of a face, counted `times` times. The part is on its left.
struct ClippedPiece {
  int face = 0;
  CurvePoint from = 0, to = 0;
  int times = 0;
};

// How often each place of one component counts: 0 at vertices that are not listed; it rises by `times` from a curve's
// right to its left.
struct CountedPart {
  std::vector<std::pair<int, int>> vertices;                // vertex, how often
  std::vector<std::pair<const SurfaceCurve*, int>> curves;  // curve, times
};

struct ClippedPart {
  std::vector<ClippedFace> faces;    // with whole faces
  std::vector<ClippedPiece> pieces;  // of faces that curves run through
  bool at_boundary = false;          // the part reaches an edge with only one triangle, so that it cannot be closed
};

// Computes moments from boundaries alone, by Green's theorem, so that curves may cross each other inside a face.
// `count` (zero for each vertex) and `cut` (zero for each triangle) are memory that calls share; they are zero again
// afterwards.
ClippedPart clip_faces(const ClosedSurface&, const std::vector<Crossing>&, const CountedPart&, std::vector<int>& count,
                       std::vector<char>& cut);

// Barycentric coordinates in a face.
std::array<double, 3> weights_in(const Surface&, const std::vector<Crossing>&, int face, CurvePoint);
Vec3 position_of(const Surface&, const Points& x, const std::vector<Crossing>&,
                 CurvePoint);  // of a crossing: its position on its edge

}  // namespace selvedge

#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "collision/penetration/surface_curve.hpp"

namespace selvedge {

// Part of a face, or several parts, each with a whole number: how often it counts. moment[k] is the integral of the
// number times the k-th corner's barycentric coordinate over the face, where the face's area is 1/2.
struct ClippedFace {
  int face = 0;
  bool whole = false;  // no curve runs through it
  std::array<double, 3> moment{};
  double covered() const { return moment[0] + moment[1] + moment[2]; }
};

// A piece of the boundary of a clipped face's part, `times` over, with the part on its left.
struct ClippedPiece {
  int face = 0;
  CurvePoint from = 0, to = 0;
  int times = 0;
};

// What counts on one component, and how often: 0 at vertices that are not listed, and at each curve a step by `times`
// from its right to its left.
struct CountedPart {
  std::vector<std::pair<int, int>> vertices;                // vertex, how often
  std::vector<std::pair<const SurfaceCurve*, int>> curves;  // curve, times
};

struct ClippedPart {
  std::vector<ClippedFace> faces;    // whole ones too
  std::vector<ClippedPiece> pieces;  // of those that curves run through
  bool at_boundary = false;          // it goes on to an edge without a second triangle: it cannot be closed
};

// By Green's theorem from the boundaries alone, so that curves may cross each other inside a face. `count` is zero for
// each vertex, `cut` for each triangle, and so they are again afterwards: memory that calls share.
ClippedPart clip_faces(const ClosedSurface&, const std::vector<Crossing>&, const CountedPart&, std::vector<int>& count,
                       std::vector<char>& cut);

// Barycentric coordinates in a face.
std::array<double, 3> weights_in(const Surface&, const std::vector<Crossing>&, int face, CurvePoint);
Vec3 position_of(const Surface&, const Points& x, const std::vector<Crossing>&,
                 CurvePoint);  // of a crossing: on its edge

}  // namespace selvedge

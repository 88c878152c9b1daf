#pragma once

#include <array>

#include "collision/geometry/points.hpp"

namespace selvedge {

// A point with its rank among all points of a query.
struct RankedPoint {
  const Vec3* at = nullptr;
  int rank = 0;
};

// Side of d against the plane of a, b, c (as orient3d) after every point has been moved by an infinitesimal amount that
// depends on its rank alone: coordinate k of rank r by e^(2^(3 r + 2 - k)), e -> 0 (simulation of simplicity,
// Edelsbrunner and Muecke 1990). The result is +1 or -1. The answers for all quadruples are consistent: they are those
// of one set of points in general position. Ranks must differ. `exact_zero` is set where the points themselves are
// coplanar and left alone otherwise.
int symbolic_orient3d(const RankedPoint& a, const RankedPoint& b, const RankedPoint& c, const RankedPoint& d,
                      bool& exact_zero);

}  // namespace selvedge

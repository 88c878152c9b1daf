#pragma once

#include <algorithm>
#include <array>

#include "collision/exact/moving_polygon.hpp"

// Is the origin in the moving polygon? At one time it is not if
//   (a) one coordinate has the same strict sign at all corners, or
//   (b) corners 0, 1, 2 have a volume with the origin, det[p0, p1, p2] != 0, since the polygon is flat, or
//   (c) seen along one axis, one side p_k p_k+1 turns left about the origin and another one turns right: a convex
//       polygon, also one without an area, that holds the origin has turns p_k x p_k+1 of one sign or zero only.
// Conversely, if the origin is not in the polygon, one of the three holds. If (b) does not, all corners are in one
// plane through the origin, and all turns are multiples of its normal. If all turns are zero, the corners are on one
// line with the origin, on one side of it: (a). Otherwise look along an axis that is not in the plane. Turns sum to
// twice the area. Where the area is zero, turns of both signs exist. Where it is not, the origin is strictly beyond
// some side, whose turn has the sign opposite to the sum's: (c).
// In time coordinates are linear, turns quadratic and the volume cubic. Over an interval a polynomial stays within its
// Bernstein coefficients. So strict signs of coefficients prove an interval free. Since coefficients converge to
// values, repeated halving proves it for every pair that does not touch.

namespace selvedge {

template <class Number>
using Corner = std::array<Number, 3>;
template <class Number>
using Corners = std::array<Corner<Number>, most_corners>;

constexpr int unknown = 2;  // a sign that may be -1, 0 or 1

// Signs of the Bernstein coefficients of a polynomial over an interval; the outer ones are those of its values at the
// ends. An unknown sign makes the lowest -1 and the highest 1.
struct Signs {
  int first, last, lowest, highest;
};

struct PolygonSigns {
  int corners;
  std::array<std::array<Signs, 3>, most_corners> coordinate, turn;
  Signs volume;
};

template <class Number>
Corner<Number> cross(const Corner<Number>& a, const Corner<Number>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Number>
Corner<Number> sum(const Corner<Number>& a, const Corner<Number>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

template <class Number>
Number dot(const Corner<Number>& a, const Corner<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Corners p at the interval's beginning and q at its end. `sign_of(sum, degree)` gives the sign of a sum of products of
// `degree` coordinates, or unknown. Signs need coefficients only up to a positive factor: binomials are left out.
template <class Number, class Sign>
PolygonSigns polygon_signs(int corners, const Corners<Number>& p, const Corners<Number>& q, const Sign& sign_of) {
  const auto signs = [&](int degree, const auto&... coefficients) {
    const std::array<int, sizeof...(coefficients)> all{sign_of(coefficients, degree)...};
    Signs result{all.front(), all.back(), 1, -1};
    for (const int sign : all) {
      result.lowest = std::min(result.lowest, sign == unknown ? -1 : sign);
      result.highest = std::max(result.highest, sign == unknown ? 1 : sign);
    }
    return result;
  };
  PolygonSigns s;
  s.corners = corners;
  for (int k = 0; k < corners; ++k) {
    const int next = (k + 1) % corners;
    const Corner<Number> turn0 = cross(p[k], p[next]), turn2 = cross(q[k], q[next]);
    const Corner<Number> turn1 = sum(cross(p[k], q[next]), cross(q[k], p[next]));
    for (int axis = 0; axis < 3; ++axis) {
      s.coordinate[k][axis] = signs(1, p[k][axis], q[k][axis]);
      s.turn[k][axis] = signs(2, turn0[axis], turn1[axis], turn2[axis]);
    }
    if (k == 0)
      s.volume = signs(3, dot(turn0, p[2]), dot(turn0, q[2]) + dot(turn1, p[2]), dot(turn1, q[2]) + dot(turn2, p[2]),
                       dot(turn2, q[2]));
  }
  return s;
}

// (a), (b) or (c) holds throughout the interval: there is no contact in it.
bool is_free(const PolygonSigns&);

// The origin passes the polygon's plane, and all the while turns seen along one axis have one sign or are zero, and one
// of them is never zero. At that moment neither (b) nor (c) holds, nor (a), since some turn is not zero: there is
// contact within the interval.
bool is_certain(const PolygonSigns&);

// Is there contact at the interval's beginning? All signs must be known.
bool touches_at_first(PolygonSigns);

}  // namespace selvedge

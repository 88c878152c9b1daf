#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Axis-aligned box in float, always rounded outward: it never loses a point that it was made from.
struct Box {
  std::array<float, 3> lo, hi;
};

constexpr Box empty_box{{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                         std::numeric_limits<float>::infinity()},
                        {-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                         -std::numeric_limits<float>::infinity()}};

inline bool is_empty(const Box& box) { return box.lo[0] > box.hi[0]; }

// Without branches, since half of them would be mispredicted. An empty box overlaps no box.
inline bool overlap(const Box& a, const Box& b) {
  return (a.lo[0] <= b.hi[0]) & (b.lo[0] <= a.hi[0]) & (a.lo[1] <= b.hi[1]) & (b.lo[1] <= a.hi[1]) &
         (a.lo[2] <= b.hi[2]) & (b.lo[2] <= a.hi[2]);
}

inline Box join(const Box& a, const Box& b) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = a.lo[k] < b.lo[k] ? a.lo[k] : b.lo[k];
    box.hi[k] = a.hi[k] > b.hi[k] ? a.hi[k] : b.hi[k];
  }
  return box;
}

// Largest float at or below a value that is not NaN. Without branches: half of them would be mispredicted. A value that
// rounds to zero keeps its sign, so that the next float below a zero that is too high is negative.
inline float round_down(double value) {
  const float nearest = static_cast<float>(value);
  const auto bits = std::bit_cast<std::int32_t>(nearest);
  const std::int32_t too_high = nearest > value, sign = (bits >> 31) | 1;
  return std::bit_cast<float>(bits - too_high * sign);
}

inline float round_up(double value) { return -round_down(-value); }

// The box of a point that moves straight from x0 to x1, grown by `radius` on every side; empty where one is NaN.
inline Box moving_point_box(const Vec3& x0, const Vec3& x1, double radius) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    const double lo = x0[k] < x1[k] ? x0[k] : x1[k], hi = x0[k] < x1[k] ? x1[k] : x0[k];
    if (lo != lo || hi != hi) return empty_box;
    box.lo[k] = round_down(lo - radius);
    box.hi[k] = round_up(hi + radius);
  }
  return box;
}

// The box round two or three boxes; empty where one of them is.
inline Box hull(const Box& a, const Box& b) { return is_empty(a) || is_empty(b) ? empty_box : join(a, b); }
inline Box hull(const Box& a, const Box& b, const Box& c) {
  return is_empty(a) || is_empty(b) || is_empty(c) ? empty_box : join(join(a, b), c);
}

inline double half_area(const Box& box) {  // of its surface
  const double x = box.hi[0] - box.lo[0], y = box.hi[1] - box.lo[1], z = box.hi[2] - box.lo[2];
  return x * y + y * z + z * x;
}

// How far the farthest corner of a box lies from a point.
inline double farthest_corner(const Box& box, const Vec3& from) {
  double squared = 0;
  for (int k = 0; k < 3; ++k) {
    const double side = std::max(std::abs(from[k] - box.lo[k]), std::abs(from[k] - box.hi[k]));
    squared += side * side;
  }
  return std::sqrt(squared);
}

}  // namespace selvedge

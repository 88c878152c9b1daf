#pragma once

#include <array>
#include <optional>

#include "collision/exact/moving_polygon.hpp"

namespace selvedge {

constexpr double time_grain = 0x1p-53;

struct FoundContact {
  double time;
  bool certain;
};

// Searches the times [from, to] of [0, 1], both whole multiples of time_grain, for the first contact at distance zero
// while the nodes move straight from x0 to x1; `polygon` is the moving polygon of x0 and x1. Signs that rounding leaves
// open are found with exact integers. So it returns nothing only if there is no contact in [from, to], and otherwise a
// time at or before the first contact: by less than 2^-30 if certain. Coordinates must be finite. Two caps leave a
// contact uncertain: an undecided part of 2^-40 of [from, to] counts as contact, and so does all that is left after
// `intervals` intervals. `intervals` is lowered by the number looked at.
std::optional<FoundContact> exact_contact(PairKind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1,
                                          const MovingPolygon& polygon, double from, double to, int& intervals);

}  // namespace selvedge

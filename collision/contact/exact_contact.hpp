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
// while the nodes move straight from x0 to x1; `polygon` is theirs. Signs that rounding leaves open are found with
// whole numbers, so it gives nothing only if there is no contact in there, and otherwise a time at or before the first
// one: by less than 2^-30 if certain. Coordinates must be finite. Capped, which leaves a contact uncertain: 2^-40 of
// [from, to] still undecided counts as contact, and so does everything that is left when as many as `intervals` have
// been looked at, which is lowered by those that were.
std::optional<FoundContact> exact_contact(PairKind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1,
                                          const MovingPolygon& polygon, double from, double to, int& intervals);

}  // namespace selvedge

#pragma once

#include <array>
#include <optional>

#include "collision/exact/moving_polygon.hpp"
#include "collision/geometry/points.hpp"

namespace selvedge {

// A time in [0, 1], never later than the true first time at which the distance of the two primitives falls to
// `min_separation` [m, >= 0] while their nodes move straight from x0 to x1; nothing if it stays above on all of [0, 1].
// This holds in exact arithmetic for the doubles as given (proofs in ccd.cpp), as long as operations round to nearest
// and underflow is gradual (floating_point.hpp). Undefined coordinates give time 0.
//
// min_separation == 0: contact itself, decided exactly (exact_contact.hpp) where rounding leaves it open. A pair is
// reported without contact only if it comes within about 2^-80 of contact, relative to the step. Contact at the start
// gives time 0.
//
// min_separation > 0: the time is early by rounding only, unless max_iterations ends the search. A pair that does not
// provably start above min_separation gets half of its starting distance as the limit instead, so that a pair that
// parts is not reported; time 0 if rounding hides that distance too.
//
// Conservative advancement, as Li et al. 2021 (C-IPC, section 5), except that a step is bounded by the motion along the
// line through the closest points, not by the full length of the motion: this allows longer steps. After
// `max_iterations` steps it returns the time reached so far, which is early, never late.
std::optional<double> time_of_contact(PairKind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1,
                                      double min_separation, int max_iterations = 256);

}  // namespace selvedge

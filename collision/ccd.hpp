#pragma once

#include <array>
#include <optional>

#include "collision/points.hpp"

namespace selvedge {

enum class PairKind { vertex_face, edge_edge };  // nodes v, f0, f1, f2 | a0, a1, b0, b1

// A time in [0, 1], never later than the true first time at which the distance of the two primitives falls to
// `min_separation` [m] while their nodes move straight from x0 to x1; nothing if it stays above on all of [0, 1].
// If the pair starts at or below min_separation, the limit is a fraction of the starting distance instead, so that a
// pair that parts is not reported; a start at distance zero gives time 0. Undefined coordinates give time 0.
// Conservative advancement with the rounding of positions (4 ulp of the largest coordinate) and of the arithmetic on
// their differences added to min_separation; after `max_iterations` it gives the time reached so far, which is early,
// never late. As Li et al. 2021 (C-IPC, section 5), except that a step is bounded by the motion along the direction
// from closest point to closest point instead of by its length: a longer step with the same proof.
std::optional<double> time_of_contact(PairKind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1,
                                      double min_separation, int max_iterations = 256);

}  // namespace selvedge

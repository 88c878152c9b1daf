#pragma once

#include <span>

#include "collision/contact/resolve.hpp"

namespace selvedge {

// Pins (nodes of the cloth without a mass) that their motion x0 -> x1 drives into what has none either: an obstacle
// that stands still, or pins of another cloth. Nothing that meets there can give way but the pins under way, and so
// they do: their ends in x1 slide along what they meet, without friction, or stay at their start. All other rows of x1
// are a guess of where things go, and are kept. Returns how many pins end elsewhere; 0, without a search, where the
// boxes of none come near each other. The work goes into the report.
int pins_give_way(PairSearch&, const ContactWorld&, std::span<const int> pins, const ResolveOptions&, const Points& x0,
                  Points& x1, PathPairs&, ResolveReport&);

}  // namespace selvedge

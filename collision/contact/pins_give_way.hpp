#pragma once

#include <span>

#include "collision/contact/resolve.hpp"

namespace selvedge {

// Pins (nodes of the cloth without a mass) that meet in the motion x0 -> x1 what has none either: an obstacle, or pins
// of another cloth. What is prescribed to an obstacle stands, so that the pins give way, those at rest as well where an
// obstacle comes to them; of two cloths those under way do. Their ends in x1 slide along what they meet, without
// friction, or stay at their start. Other rows of x1 are a guess of where things go; those of obstacles may come back
// changed where pins are caught between two. Returns how many pins end elsewhere; 0, without a search, where the boxes
// of none come near each other. The work goes into the report.
int pins_give_way(PairSearch&, const ContactWorld&, std::span<const int> pins, const ResolveOptions&, const Points& x0,
                  Points& x1, PathPairs&, ResolveReport&);

}  // namespace selvedge

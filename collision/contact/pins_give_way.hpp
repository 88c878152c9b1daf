#pragma once

#include <span>

#include "collision/contact/contact_pairs.hpp"
#include "collision/contact/resolve_options.hpp"

namespace selvedge {

// For pins (cloth nodes with prescribed motion) that would meet an obstacle, or pins of another patch (pins_apart.hpp),
// of the same cloth or another one, in the motion x0 -> x1. Obstacles keep their prescribed motion, so that pins give
// way, even pins at rest that an obstacle runs into; between two patches moving pins give way. Their ends in x1 slide
// along what they meet, without friction, or stay at their start. Other rows of x1 are a guess; obstacle rows may
// change where pins are caught between two obstacles. Returns how many pins end elsewhere: 0, without a search, if no
// boxes come near each other. Work and times are written to the report.
int pins_give_way(PairSearch&, const ContactWorld&, std::span<const int> pins, const ResolveOptions&, const Points& x0,
                  Points& x1, ResolveReport&);

}  // namespace selvedge

#pragma once

#include <string>

#include "pipeline/patterns/pattern.hpp"

namespace selvedge {

// Finds the loop of every panel. Throws Error, naming `file`, panel and edge, for places that are absurdly far, edges
// without length, arcs that do not reach, loops that do not close or cross themselves, and edges that two stitches sew.
void check_pattern(Pattern&, const std::string& file);

}  // namespace selvedge

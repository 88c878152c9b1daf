#pragma once

#include <string>

#include "pipeline/patterns/pattern.hpp"

namespace selvedge {

// Finds the loop of every panel. Throws Error, naming `file`, panel and edge, for absurdly distant places, edges
// without length, arcs with too small a radius, loops that do not close or cross themselves, and edges in two stitches.
void check_pattern(Pattern&, const std::string& file);

}  // namespace selvedge

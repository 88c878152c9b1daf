#pragma once

#include "pipeline/config.hpp"

namespace selvedge {

struct ClothPart;

// Puts a placed cloth where its `start` section has it. One that then starts in one point, an exact equilibrium of any
// membrane, is opened by random displacements of a thousandth of its mean edge; a warning says so.
void apply_start(const Config& section, ClothPart&, std::vector<std::string>& warnings);

}  // namespace selvedge

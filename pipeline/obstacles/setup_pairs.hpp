#pragma once

#include <array>
#include <span>
#include <vector>

#include "pipeline/config/config.hpp"

namespace selvedge {

// Vertices in pairs, as the key `pair` of a section with `from` and `to` asks: one by one, or each of `from` with the
// nearest of `to` in x, the first one on a tie. Throws Error where the sides do not fit together.
std::vector<std::array<int, 2>> read_pairs(const Config& section, std::span<const int> from, std::span<const int> to,
                                           const Points& x);

}  // namespace selvedge

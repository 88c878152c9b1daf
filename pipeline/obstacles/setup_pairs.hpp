#pragma once

#include <array>
#include <span>
#include <vector>

#include "pipeline/config/config.hpp"

namespace selvedge {

// Pairs of vertices, by the key `pair` of a section with `from` and `to`: one by one in order, or each of `from` with
// the nearest of `to` in x (the first on a tie). Throws Error if sides in order differ in number, or a vertex is paired
// with itself.
std::vector<std::array<int, 2>> read_pairs(const Config& section, std::span<const int> from, std::span<const int> to,
                                           const Points& x);

}  // namespace selvedge

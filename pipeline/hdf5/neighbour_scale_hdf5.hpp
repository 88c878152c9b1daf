#pragma once

#include <filesystem>

#include "learned/repulsion/neighbour_scale.hpp"

namespace selvedge {

// A small file of scales by neighbours (some kilobytes). Reading checks it; both functions throw Error.
void write_neighbour_scale(const std::filesystem::path&, const NeighbourScale&);
NeighbourScale read_neighbour_scale(const std::filesystem::path&);

}  // namespace selvedge

#pragma once

#include <filesystem>

#include "learned/repulsion/neighbour_scale.hpp"

namespace selvedge {

// A file of scales by neighbours, of some kilobytes. What is read is checked; both throw Error.
void write_neighbour_scale(const std::filesystem::path&, const NeighbourScale&);
NeighbourScale read_neighbour_scale(const std::filesystem::path&);

}  // namespace selvedge

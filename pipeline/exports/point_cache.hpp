#pragma once

#include <filesystem>

#include "pipeline/exports/animated_surfaces.hpp"

namespace selvedge {

// Positions of one surface of a run, every frame, without its triangles. Both are streamed. Throw Error for a file that
// cannot be written.

// Point cache 2: "POINTCACHE2\0", version 1, points, first frame, frames a sample, samples (all of 4 bytes), then x y z
// as floats, little-endian.
void write_pc2(const std::filesystem::path&, const AnimatedSurfaces&, std::size_t surface);

// MDD: frames and points, the time of each frame [s], then x y z as floats, big-endian.
void write_mdd(const std::filesystem::path&, const AnimatedSurfaces&, std::size_t surface);

}  // namespace selvedge

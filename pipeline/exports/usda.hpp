#pragma once

#include <filesystem>

#include "pipeline/exports/animated_surfaces.hpp"

namespace selvedge {

// USD as text: a Mesh a surface below the Xform `run`, metres, Y up, a time sample of `points` a frame, rounded to a
// micrometre. Cloths carry the schema of deformable surfaces that the AOUSD proposes and newton reads, obstacles that
// of colliders. Surfaces that never move have one value. The text is streamed, a surface after the other. Throws Error
// for positions that are not finite and a file that cannot be written.
void write_usda(const std::filesystem::path&, const AnimatedSurfaces&);

}  // namespace selvedge

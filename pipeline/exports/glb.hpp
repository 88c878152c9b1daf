#pragma once

#include <filesystem>

#include "pipeline/exports/animated_surfaces.hpp"

namespace selvedge {

// glTF 2.0, binary: a mesh a surface, a morph target a frame, and one animation that goes from each to the next. Each
// position is a whole number on a grid of 65,534 steps along the longest side of the box that the surface fills over
// the run (KHR_mesh_quantization), so that it is off by at most 8e-6 of that side: 8 bytes a vertex and frame. Surfaces
// that never move have no targets. Normals are left to the reader.
//
// Throws Error for positions that are not finite, a file beyond the 4 GiB of the format, and one that cannot be
// written.
void write_glb(const std::filesystem::path&, const AnimatedSurfaces&);

}  // namespace selvedge

#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/exports/animated_surfaces.hpp"
#include "pipeline/exports/moved_normals.hpp"

namespace selvedge {

// The slots of each surface's normals, which are the same in all frames.
std::vector<NormalSlots> normal_slots(std::span<const AnimatedSurface> surfaces);

// OBJ of surfaces at positions x, an object each. One with a look has the vertices, faces, texture coordinates,
// materials and parts of its file, and normals moved with it. One alone without a look is vertices and triangles.
// slots: of these surfaces.
std::string objects_text(std::span<const AnimatedSurface> surfaces, std::span<const NormalSlots> slots,
                         std::span<const PointsF> x, const std::string& material_file);

// The .mtl file of these surfaces, which objects_text names. Empty: they have no materials.
std::string objects_materials(std::span<const AnimatedSurface> surfaces);

}  // namespace selvedge

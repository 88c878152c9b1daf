#pragma once

#include <vector>

#include "collision/geometry/welded_surface.hpp"
#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Of each vertex the lowest one that is at its place in every shape and pose: at the same place at rest
// (same_places.hpp), with the same weights and directions.
std::vector<int> same_places(const SkinnedSurface&);

// same_places of the body's skin, and where it is open after that, also what closed_where_open (mesh_weld.hpp) joins,
// with its meshes as parts. Vertices whose directions differ by more than a seam's width stay apart.
std::vector<int> seam_places(const BodyModel&);

// The body's surface with its seams closed there. All vertices keep their numbers; `joined` is empty where nothing was
// joined.
WeldedSurface closed_surface(const BodyModel&);

}  // namespace selvedge

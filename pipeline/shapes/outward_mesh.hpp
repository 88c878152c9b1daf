#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// Turns closed shells outwards (outward_faces.hpp); called for every mesh that becomes an obstacle or a body. Of a
// piece all of whose triangles lie on others that face the other way, a two-sided one, the later ones are left out
// before. Warnings, with `name` (the file's) and mesh, list these, shells that were turned, shells taken for cavities,
// and shells without an inside that were probably meant to have one: nearly closed ones, and ones closed except for
// edges of many triangles. `places`: as for face_outward. Returns whether any shell is closed or nearly so.
bool turn_outward(const std::string& name, const NamedVertices& groups, std::span<const Points> frames,
                  const std::vector<int>& places, Triangles& triangles, std::vector<std::string>& warnings);

// The same for a mesh that stands still, in any unit.
void turn_outward(const std::string& name, Mesh&, std::vector<std::string>& warnings);

}  // namespace selvedge

#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// Every mesh that becomes an obstacle or a body goes through here: its closed shells are turned outwards
// (outward_faces.hpp). Warnings say, by `name` (the file's) and mesh, what was turned, what is taken for a cavity, and
// what has no inside though it is meant to: what is nearly closed, or closed but for edges of many triangles.
// `places` as face_outward has them.
void turn_outward(const std::string& name, const NamedVertices& groups, std::span<const Points> frames,
                  const std::vector<int>& places, Triangles& triangles, std::vector<std::string>& warnings);

// The same for a mesh that stands still, in whatever unit.
void turn_outward(const std::string& name, Mesh&, std::vector<std::string>& warnings);

}  // namespace selvedge

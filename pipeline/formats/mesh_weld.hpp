#pragma once

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// How many vertices lie where a lower one does (same_places.hpp).
int coincident_vertices(const Points& x);

// Joins vertices that lie at one place: the lowest of them stays, vertices are numbered anew in their order, triangles
// that lose their area are left out and counted in a warning. Sets Mesh::welded.
void weld(Mesh&, const std::string& name);

// The same for a mesh with the same vertices and faces as the one that `welded` is of.
void weld_as(const Mesh& welded, Mesh&);

}  // namespace selvedge

#pragma once

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// The number of vertices at the place of a lower one (same_places.hpp).
int coincident_vertices(const Points& x);

// Before vertices are joined: numbers[v] is the number that v gets. The look keeps the vertices and faces of the file.
void renumber_look(const std::vector<int>& numbers, Mesh&);

// Joins vertices at one place into the lowest of them and numbers vertices anew in their order. Triangles that lose
// their area are removed and counted in a warning. Sets Mesh::welded.
void weld(Mesh&, const std::string& name);

// Joins the same vertices in another mesh with the same vertices and faces.
void weld_as(const Mesh& welded, Mesh&);

}  // namespace selvedge

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// OBJ (polygons, negative indices, vt, groups) and PLY (ascii, binary little and big endian), by extension.
// Throws Error with file and line for what cannot be read: empty, NaN, index out of range, no faces.
Mesh read_mesh(const std::filesystem::path&);

// The same triangles in the same order; the numbers of triangles may differ.
bool same_triangles(const Triangles& a, const Triangles& b);
// As many vertices and the same faces in the same order: polygons, however they are cut into triangles, where both were
// read; else triangles.
bool same_faces(const Mesh& a, const Mesh& b);

// Leaves out triangles that name a vertex twice and triangles that come again, in whatever order of corners, and counts
// them in warnings; `name` is the mesh's.
void leave_out_repeated(Mesh&, const std::string& name);

// Written beside and renamed: a reader never sees half a file.
void write_mesh(const std::filesystem::path&, const Points& x, const Triangles&);  // by extension
// The mesh of `from`, which was read as `mesh`, with other positions. OBJ to OBJ keeps every other line; what else is
// left out, and normals that stay behind, are named in the warnings.
void write_moved(const std::filesystem::path& from, const std::filesystem::path& to, const Points& x, const Mesh& mesh,
                 std::vector<std::string>& warnings);
void write_obj(const std::filesystem::path&, const Points& x, const Triangles&);
void write_ply(const std::filesystem::path&, const Points& x, const Triangles&);

}  // namespace selvedge

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// OBJ (polygons, negative indices, vt, groups) and PLY (ascii, binary little and big endian), by extension. Throws
// Error with file and line for a file that is empty or not readable, NaN, an index out of range, or no faces.
Mesh read_mesh(const std::filesystem::path&);

// True for the same triangles in the same order; false if their numbers differ.
bool same_triangles(const Triangles& a, const Triangles& b);
// True for equally many vertices and the same faces in the same order: the same polygons, however they are cut into
// triangles, or the same triangles.
bool same_faces(const Mesh& a, const Mesh& b);

// Removes triangles that name a vertex twice and repeated triangles, in any order of corners, and counts them in a
// warning; `name` is the mesh's.
void leave_out_repeated(Mesh&, const std::string& name);

// Both write to a file beside it and rename that, so that readers never see half a file. They throw Error on failure.
void write_mesh(const std::filesystem::path&, const Points& x, const Triangles&);  // by extension
// Writes the mesh of `from`, which was read as `mesh`, with other positions. OBJ to OBJ keeps every other line;
// warnings name parts that are left out, and normals that no longer match.
void write_moved(const std::filesystem::path& from, const std::filesystem::path& to, const Points& x, const Mesh& mesh,
                 std::vector<std::string>& warnings);
void write_obj(const std::filesystem::path&, const Points& x, const Triangles&);
void write_ply(const std::filesystem::path&, const Points& x, const Triangles&);

}  // namespace selvedge

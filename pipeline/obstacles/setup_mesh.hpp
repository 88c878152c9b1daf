#pragma once

#include <filesystem>

#include "pipeline/config/config.hpp"
#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// The mesh that a `mesh` section names, in metres, welded if the section asks for it. `folder` is the scene file's.
Mesh read_mesh_section(const Config& section, const std::filesystem::path& folder);

// Joins the pieces of a mesh in metres where the section's key `weld` asks for it. `name` is the mesh's.
void read_weld(const Config& section, const std::string& name, Mesh&);

// Throws Error, naming the vertex and where it is, for a position that is not finite or farther from the origin than
// bounds.hpp allows. `at`: the value from which they were read; `noun`: what has these positions.
void refuse_far(const Config& at, const std::string& noun, const Points& x);

// Adds a warning if a mesh from a file, as placed, is larger than `largest` or smaller than a centimetre, since files
// have units of their own. Vertices in no triangle do not count. `section`: that with the key `scale`.
// `has_unit`: whether there is a key `unit` too.
inline constexpr double largest_cloth = 10, largest_body = 20, largest_obstacle = 50;  // diagonals of boxes [m]
void warn_of_extent(const Config& section, const std::string& noun, double largest, bool has_unit, const Points& x,
                    const Triangles&, std::vector<std::string>& warnings);

}  // namespace selvedge

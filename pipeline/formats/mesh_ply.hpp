#pragma once

#include <string>
#include <string_view>

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// The mesh as the file has it: indices in range, coordinates finite, faces cut into triangles (polygon.hpp); degenerate
// and duplicate triangles are still in. `text` is the whole file, `name` is for messages. Throws Error.
Mesh parse_ply(std::string_view text, const std::string& name);
std::string ply_text(const Points& x, const Triangles&);  // binary little endian, double coordinates

}  // namespace selvedge

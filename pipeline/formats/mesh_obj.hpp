#pragma once

#include <string>
#include <string_view>

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// The mesh as the file has it: indices in range, coordinates finite, faces cut into triangles (polygon.hpp); degenerate
// and duplicate triangles are still in. `text` is the whole file, `name` is for messages. Throws Error with the line.
Mesh parse_obj(std::string_view text, const std::string& name);
std::string obj_text(const Points& x, const Triangles&);
// The same text with other positions: one row of x for each `v` line; other lines stay.
std::string moved_obj_text(std::string_view text, const Points& x);

}  // namespace selvedge

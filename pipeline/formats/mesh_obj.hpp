#pragma once

#include <string>
#include <string_view>

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// The mesh as the file has it: indices in range, coordinates finite, faces cut into triangles (polygon.hpp); degenerate
// and duplicate triangles are still in. `text` is the whole file, `name` stands in messages.
Mesh parse_obj(std::string_view text, const std::string& name);
std::string obj_text(const Points& x, const Triangles&);
// The same text with other positions: one row of x for each `v` line, all else as it is.
std::string moved_obj_text(std::string_view text, const Points& x);

}  // namespace selvedge

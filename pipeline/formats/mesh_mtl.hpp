#pragma once

#include <string>
#include <vector>

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// What becomes of a .mtl file that cannot be read, or does not lie below the mesh's folder.
enum class MissingMtl { warn, ignore };

// Reads the .mtl files that the mesh names, for its look. Materials that no file describes keep their names alone. To
// simulate needs no colours, so that scenes ignore what is missing; what writes looks names it in a warning.
void read_materials(Mesh&, MissingMtl = MissingMtl::warn);

std::string mtl_text(const std::vector<LookMaterial>&);

}  // namespace selvedge

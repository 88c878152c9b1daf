#pragma once

#include <string>

#include "pipeline/patterns/pattern_mesh.hpp"

namespace selvedge {

// How far a body [m] reaches below the floor at y = 0 on which patterns have it stand; 0 where it does not. Bodies have
// their origin at the pelvis as well as between the soles.
double below_floor(const Points& body);

// Throws Error that says where panels and body are, unless panels as placed stand round the body: a third of their
// vertices at its heights at least, and what the body has at theirs between them.
void check_stands_round(const PatternMesh&, const Points& body, const std::string& file);

}  // namespace selvedge

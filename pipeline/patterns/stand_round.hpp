#pragma once

#include <string>

#include "pipeline/patterns/pattern_mesh.hpp"

namespace selvedge {

// How far a body [m] reaches below y = 0, the floor that patterns assume; 0 if it does not. (Some bodies have their
// origin at the pelvis, others between the soles.)
double below_floor(const Points& body);

// Throws Error, with the places of panels and body, unless the placed panels stand round the body: at least a third of
// their vertices are at its heights, and the body's part at their heights is between them.
void check_stands_round(const PatternMesh&, const Points& body, const std::string& file);

}  // namespace selvedge

#pragma once

#include "pipeline/patterns/pattern_mesh.hpp"

namespace selvedge {

// Where panels begin, so that stitches run past the body [m]. A stitch pulls along a straight line: where that grazes
// an arm below its top, the panels' edges slide together on the wrong side of it. Panels of such a seam are moved
// without turning, with those that lie on them already, where that frees every stitch of the seam and no other stitch
// comes to lie deeper in the body, no vertex in it, and no panel in another; else they stay.
Points clear_of(const PatternMesh&, const Points& body, const Triangles& body_triangles);

}  // namespace selvedge

#pragma once

#include "pipeline/patterns/pattern_mesh.hpp"

namespace selvedge {

// Starting positions of panels [m] with stitches that do not cut the body. A stitch pulls along a straight line: if
// this passes through an arm below its top, the panels' edges slide together on the wrong side of the arm. The panels
// of such a seam, with panels that already touch them, are translated if that frees every stitch of the seam and leaves
// no other stitch deeper in the body, no vertex inside it, and no panel inside another; else they stay.
Points clear_of(const PatternMesh&, const Points& body, const Triangles& body_triangles);

}  // namespace selvedge

#pragma once

#include <string>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// What is wrong with a mesh that becomes cloth, a sentence each:
// Neighbouring triangles lie folded flat on each other, as those of a face do whose edges cross. Contact cannot part
// them, since they share an edge, and the cloth round them does not move. Triangles without area do not count.
// T-junctions: vertices at the border lie on border edges of other triangles and not at their ends, within a thousandth
// of the edge. The cloth is open there.
std::vector<std::string> mesh_faults(const Points& x, const Triangles&);

}  // namespace selvedge

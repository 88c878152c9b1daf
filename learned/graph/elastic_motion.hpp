#pragma once

#include "learned/graph/graph_state.hpp"
#include "physics/solve/assembly.hpp"

namespace selvedge {

// How far elastic forces alone would move each vertex from `guess` in a frame: -dt^2 dE/dx / m, V x 3 [m], by the
// solver's energies. Zero where a vertex is pinned or has no mass, and where the motion is not finite.
Points elastic_motion(const Elastic&, const GraphScene&, double dt, const Points& guess, AssemblyScratch&);

}  // namespace selvedge

#pragma once

#include <vector>

#include "collision/audit/moving_body.hpp"

namespace selvedge {

// The star of a vertex: the triangles round it. Returns 1 for each vertex of a moving cloth whose star is proven to be
// clean: its triangles share no more than their common vertices and edges, at all times of the straight motion, and
// also where each coordinate is anywhere within `reach` [m] of the end. 0 says nothing. Isolated vertices have 0.
//
// A direction is sought along which all triangles of the star are seen from the same side, and go round the vertex at
// most once. Seen along it they do not overlap, and so they do not in space.
std::vector<char> clean_stars(const MovingBody& cloth, double reach);

}  // namespace selvedge

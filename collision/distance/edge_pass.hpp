#pragma once

#include "collision/distance/signed_distance.hpp"
#include "collision/search/intersections.hpp"

namespace selvedge {

struct EdgePassOptions {
  int rounds = 1;
  double margin = 1e-4;  // in front of the surface, where the deepest point of an edge is to be [m]
  bool count = true;     // the pairs that are left in the end; a search that nothing else needs
};

struct EdgePassReport {
  int pairs_before = 0, pairs_after = -1;  // triangles of garment and body that meet; -1: not counted
  int edges = 0, faces = 0;                // that were moved, all rounds
};

// Kept between calls for the same garment and body: it saves time and changes nothing else.
struct EdgePassMemory {
  IntersectionCache garment, body;
};

// Edges and faces of a garment that still pass through a body whose inside no vertex is in. A round asks both ends of
// each such edge to move by -(f - margin) n w, w = (1 - t, t) / ((1 - t)^2 + t^2), where t is the deepest point of the
// edge, with distance f and normal n: that point then lies at the margin. The corners of each triangle that meets the
// body are asked likewise for its deepest point inside, since a face over a round body lies deeper than its edges. A
// vertex goes by about the shortest motion that grants all that it is asked for; by their mean the
// deepest edges stay in. Vertices marked in `held`, which may be empty, stay. Every round starts from the positions
// that the last one left. Edges that only touch the body count as well: those of triangles that meet it, with a point
// nearer than half of the margin.
EdgePassReport pass_edges(const DistanceField& body, const Surface& garment, const EdgePassOptions&, Points& x,
                          std::span<const char> held = {}, EdgePassMemory* = nullptr);

}  // namespace selvedge

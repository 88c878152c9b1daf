#pragma once

#include "collision/distance/signed_distance.hpp"
#include "collision/search/intersections.hpp"

namespace selvedge {

struct EdgePassOptions {
  int rounds = 1;
  double margin = 1e-4;  // distance in front of the surface to which the deepest point of an edge is moved [m]
  bool count = true;     // count the pairs that are left: costs one more search
};

struct EdgePassReport {
  int pairs_before = 0, pairs_after = -1;  // triangles of garment and body that meet; -1: not counted
  int edges = 0, faces = 0;                // that were moved, all rounds
};

// Kept between calls for the same garment and body: it saves time and changes nothing else.
struct EdgePassMemory {
  IntersectionCache garment, body;
};

// Moves edges and faces of a garment out of a body after its vertices are outside. A round asks both ends of each edge
// that meets the body to move by -(f - margin) n w, w = (1 - t, t) / ((1 - t)^2 + t^2), where t is the deepest point of
// the edge, with distance f and normal n: that point then lies at the margin. The corners of each triangle that meets
// the body are asked likewise for its deepest point, since a face over a round body lies deeper than its edges. A
// vertex moves by about the shortest motion that fulfils all its demands; their mean would leave the deepest edges
// inside. Vertices marked in `held`, which may be empty, stay. Every round starts from the positions that the last one
// left. Edges that only touch the body count too: those of triangles that meet it, with a point nearer than half of the
// margin.
EdgePassReport pass_edges(const DistanceField& body, const Surface& garment, const EdgePassOptions&, Points& x,
                          std::span<const char> held = {}, EdgePassMemory* = nullptr);

}  // namespace selvedge

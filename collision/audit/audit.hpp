#pragma once

#include <span>
#include <utility>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Independent proof that a state is clean: its own broad phase (bisection of space), its own exact tests of triangles
// and of sides. In common with proximity, CCD and response it has the surface and exact orientation.
struct Audit {
  std::vector<std::pair<int, int>> self_pairs;      // intersecting cloth triangles that share no vertex
  std::vector<std::pair<int, int>> vertex_pairs;    // cloth triangles that share one vertex and cross along a segment
  std::vector<std::pair<int, int>> obstacle_pairs;  // (cloth triangle, obstacle triangle), obstacles numbered on end
  int inside_vertices = 0;                          // cloth vertices strictly inside a closed obstacle
  int nonfinite = 0;                                // vertices with a NaN or infinite coordinate (left out of the rest)
  int intersecting_pairs() const { return static_cast<int>(self_pairs.size() + obstacle_pairs.size()); }
};

struct AuditBody {
  const Surface* surface = nullptr;
  const Points* points = nullptr;
};

struct AuditMemory;

// Pairs come sorted. Isolated vertices are not tested for inside; neither is an obstacle that is open or not finite.
// self = false leaves the cloth-cloth test out. memory: saves time, and changes nothing else. Throws TooManyPairs where
// the boxes of more overlap than an audit may look at (pair_budget.hpp): it says so, and never leaves pairs out.
Audit audit(const Surface& cloth, const Points& x, std::span<const AuditBody> obstacles, bool self = true,
            AuditMemory* memory = nullptr);

// Smallest distance between two triangles that share no vertex, within the cloth and from cloth to obstacles [m];
// zero where any intersect; infinity where there is no such pair within `horizon`. Throws TooManyPairs as an audit
// does.
double min_gap(const Surface& cloth, const Points& x, std::span<const AuditBody> obstacles, double horizon);

}  // namespace selvedge

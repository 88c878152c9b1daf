#pragma once

#include <span>
#include <utility>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Independent proof that a state is clean: its own broad phase (a tree of boxes in double), its own exact tests of
// triangles and of sides. It shares only surfaces and exact orientation with proximity, CCD and response.
struct Audit {
  std::vector<std::pair<int, int>> self_pairs;      // intersecting cloth triangles that share no vertex
  std::vector<std::pair<int, int>> vertex_pairs;    // cloth triangles that share one vertex and cross along a segment
  std::vector<std::pair<int, int>> obstacle_pairs;  // (cloth triangle, obstacle triangle), numbered over all obstacles
  int inside_vertices = 0;                          // cloth vertices strictly inside a closed obstacle
  int nonfinite = 0;                                // vertices with a NaN or infinite coordinate (left out of the rest)
  int intersecting_pairs() const { return static_cast<int>(self_pairs.size() + obstacle_pairs.size()); }
};

struct AuditBody {
  const Surface* surface = nullptr;
  const Points* points = nullptr;
};

struct AuditMemory;

// Pairs are sorted. Isolated vertices are not tested for being inside, and no vertex is tested against an obstacle that
// is open or not finite. self = false leaves out the test of cloth against cloth. `memory` only saves time. Throws
// TooManyPairs where the boxes of too many pairs overlap (pair_budget.hpp), rather than leaving any out.
Audit audit(const Surface& cloth, const Points& x, std::span<const AuditBody> obstacles, bool self = true,
            AuditMemory* memory = nullptr);

// Smallest distance between two triangles that share no vertex, within the cloth and from cloth to obstacles [m];
// zero where any intersect; infinity where there is no such pair within `horizon`. Throws TooManyPairs as an audit
// does.
double min_gap(const Surface& cloth, const Points& x, std::span<const AuditBody> obstacles, double horizon);

}  // namespace selvedge

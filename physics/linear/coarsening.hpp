#pragma once

#include <span>
#include <vector>

#include "collision/geometry/adjacency.hpp"

namespace selvedge {

// A level of a hierarchy of vertices: where they rest, who neighbours whom, and which edge of the cloth they lie on.
enum class Rim : char { inside, border, corner };
struct Vertices {
  Points rest;
  Adjacency graph;
  std::vector<Rim> rim;
};

// Linear interpolation from coarse to fine vertices: a fine value is the weighted mean of its row's coarse values.
// Weights are positive and sum to one; what would come from a vertex that is not free is left out.
struct Prolongation {
  std::vector<int> begin, coarse;
  std::vector<double> weight;
  std::vector<int> chosen;  // the fine vertex that each coarse one is
  int fine_count() const { return static_cast<int>(begin.size()) - 1; }
  int coarse_count() const { return static_cast<int>(chosen.size()); }
};

// Keeps about one vertex in four: a maximal set of which no two are neighbours, corners first, then borders. Each of
// the others lies between three kept vertices (on a border: two) of its surroundings in the tangent plane at rest,
// which keeps linear functions on flat rest shapes. Deterministic.
Prolongation coarsen(const Vertices&, std::span<const char> free);

// The kept vertices; neighbours are those that two neighbouring fine vertices, or one, interpolate from.
Vertices coarse_vertices(const Vertices& fine, const Prolongation&);

// Borders of a mesh are edges with one triangle; a corner is where they turn by more than 40 degrees, end or meet.
std::vector<Rim> rims(const Points& rest, const Edges& border);

}  // namespace selvedge

#pragma once

#include <span>
#include <vector>

#include "collision/geometry/adjacency.hpp"

namespace selvedge {

// A level of a hierarchy of vertices: rest positions [m], neighbours, and whether they lie on a border of the cloth.
enum class Rim : char { inside, border, corner };
struct Vertices {
  Points rest;
  Adjacency graph;
  std::vector<Rim> rim;
};

// Linear interpolation from coarse to fine vertices: a fine value is the weighted mean of its row's coarse values.
// Weights are positive and sum to one; those of vertices that are not free are then left out.
struct Prolongation {
  std::vector<int> begin, coarse;
  std::vector<double> weight;
  std::vector<int> chosen;  // the fine vertex of each coarse one
  int fine_count() const { return static_cast<int>(begin.size()) - 1; }
  int coarse_count() const { return static_cast<int>(chosen.size()); }
};

// Keeps about one vertex in four: a maximal independent set, corners first, then borders. Each other vertex is
// interpolated from three kept vertices nearby (on a border: two) round it in the tangent plane at rest, so that linear
// functions on flat rest shapes are exact. Deterministic.
Prolongation coarsen(const Vertices&, std::span<const char> free);

// The kept vertices. Two are neighbours if one fine vertex, or two neighbouring ones, interpolate from both.
Vertices coarse_vertices(const Vertices& fine, const Prolongation&);

// Borders of a mesh are edges with one triangle; a corner is where they turn by more than 40 degrees, end or meet.
std::vector<Rim> rims(const Points& rest, const Edges& border);

}  // namespace selvedge

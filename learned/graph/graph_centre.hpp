#pragma once

#include "collision/geometry/adjacency.hpp"

namespace selvedge {

// Of the connected component of `start`: the vertex of least eccentricity, the lowest of several. Bounds from each
// breadth-first search exclude most vertices from being searched from (Takes and Kosters 2013), so that a garment takes
// a few dozen searches.
int graph_centre(const Adjacency&, int start);

// The middle of a path between two vertices far apart: three searches, whatever the shape (ContourCraft's option
// approximate_center).
int approximate_graph_centre(const Adjacency&, int start);

}  // namespace selvedge

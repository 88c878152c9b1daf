#pragma once

#include "collision/geometry/adjacency.hpp"

namespace selvedge {

// The vertex of least eccentricity in the connected component of `start`, the lowest of several. Bounds from each
// breadth-first search exclude most vertices (Takes and Kosters 2013), so that a garment takes a few dozen searches.
int graph_centre(const Adjacency&, int start);

// The middle of a path between two vertices far apart, found by three searches (ContourCraft's option
// approximate_center).
int approximate_graph_centre(const Adjacency&, int start);

}  // namespace selvedge

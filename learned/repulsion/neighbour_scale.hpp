#pragma once

#include "learned/repulsion/repulsive_layer.hpp"

namespace selvedge {

// Scales for a garment of any topology, beyond Tan et al. 2022, whose k has rows for the vertices of one garment. A
// vertex reads its distance, the smallest distance at it and at the midpoints of its edges, and the mean length of its
// edges. Then it reads its neighbours twice: p = first(own, mean of the neighbours' own), q = second(p, mean of the
// neighbours' p), alpha = g(q, f). An activation follows `first` and `second`.
struct NeighbourShape {
  int width = 16;           // width of p and q
  double unit = 0.01;       // unit of distances [m]
  double edge_unit = 0.02;  // unit of lengths [m]
  ScaleRange range = ScaleRange::at_least_one;
};

struct NeighbourScale {
  NeighbourShape shape;
  PlainNetwork first, second, end;
};

// Scales begin near 1.02. Throws Error for sizes that give no network.
NeighbourScale make_neighbour_scale(const NeighbourShape&, std::uint64_t seed);

// The smallest distance of a vertex and its edges.
struct SmallestDistance {
  int other = -1;  // at the midpoint of the edge to that vertex; -1: at the vertex itself
  double value = 0;
  Vec3 gradient = Vec3::Zero();
};

// The vertices that affect the scales of pushed vertices: these, their neighbours, and the neighbours of those.
struct NeighbourPatch {
  std::vector<int> vertex;   // vertices of the garment
  int pushed = 0, near = 0;  // number of pushed vertices; number of these and their neighbours
  std::vector<double> distance;
  std::vector<Vec3> gradient;  // of the distance
  std::vector<SmallestDistance> smallest;
  std::vector<double> length;               // mean length of the edges [m]; 0: no edges
  std::vector<std::vector<int>> neighbour;  // places in the patch, for the first `near` vertices
};
NeighbourPatch neighbour_patch(const Points& x, const Adjacency& ring, const AskDistance&, std::span<const int> pushed);

// Scales of the pushed vertices. Their slopes are 0, because alpha depends on more than a vertex's own distance
// (neighbour_gradients).
Scales neighbour_scales(const NeighbourScale&, const NeighbourPatch&);
// The same as a function for a layer over these positions. It keeps references to all but `ask`.
AskScale ask_neighbours(const NeighbourScale&, const Points& x, const Adjacency& ring, const AskDistance& ask);

// Gradient of a loss by all parameters, and by the garment's positions through the scales only. `by_alpha` is the
// derivative by the scale of each pushed vertex.
struct NeighbourGradients {
  std::vector<float> first, second, end;  // in the order of parameters_of
  Points by_x;
};
NeighbourGradients neighbour_gradients(const NeighbourScale&, const NeighbourPatch&, const Points& x,
                                       const Adjacency& ring, std::span<const double> by_alpha);

}  // namespace selvedge

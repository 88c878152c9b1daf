#pragma once

#include "learned/repulsion/repulsive_layer.hpp"

namespace selvedge {

// Scales for a garment of any topology, beyond Tan et al. 2022, whose k has rows for the vertices of one garment. A
// vertex reads its distance, the smallest distance at it and in the middles of its edges, and the mean length of its
// edges; then it looks at its neighbours twice:
//   p = first(own, mean of the neighbours' own),  q = second(p, mean of the neighbours' p),  alpha = g(q, f).
// Behind `first` and `second` there is a bend.
struct NeighbourShape {
  int width = 16;           // of p and q
  double unit = 0.01;       // in which distances are read [m]
  double edge_unit = 0.02;  // in which lengths are read [m]
  ScaleRange range = ScaleRange::at_least_one;
};

struct NeighbourScale {
  NeighbourShape shape;
  PlainNetwork first, second, end;
};

// Scales begin near 1.02. Throws Error for sizes that make no network.
NeighbourScale make_neighbour_scale(const NeighbourShape&, std::uint64_t seed);

// Where the smallest distance of a vertex and its edges was found.
struct SmallestDistance {
  int other = -1;  // in the middle of the edge to that vertex; -1: at the vertex itself
  double value = 0;
  Vec3 gradient = Vec3::Zero();
};

// What scales of pushed vertices depend on: these, their neighbours and those of them, in this order.
struct NeighbourPatch {
  std::vector<int> vertex;   // of the garment
  int pushed = 0, near = 0;  // how many are pushed; how many are pushed or their neighbours
  std::vector<double> distance;
  std::vector<Vec3> gradient;  // of the distance
  std::vector<SmallestDistance> smallest;
  std::vector<double> length;               // mean of the edges [m]; 0 without any
  std::vector<std::vector<int>> neighbour;  // places in the patch, of the near ones
};
NeighbourPatch neighbour_patch(const Points& x, const Adjacency& ring, const AskDistance&, std::span<const int> pushed);

// Scales of the pushed vertices. Their slopes are 0: alpha depends on more than a vertex's own distance, and
// neighbour_gradients says how.
Scales neighbour_scales(const NeighbourScale&, const NeighbourPatch&);
// The same for a layer over these positions. Keeps references to all but `ask`.
AskScale ask_neighbours(const NeighbourScale&, const Points& x, const Adjacency& ring, const AskDistance& ask);

// Gradient of a loss by all parameters, and by the garment's positions through the scales alone. `by_alpha`: derivative
// by the scale of each pushed vertex.
struct NeighbourGradients {
  std::vector<float> first, second, end;  // in the order of parameters_of
  Points by_x;
};
NeighbourGradients neighbour_gradients(const NeighbourScale&, const NeighbourPatch&, const Points& x,
                                       const Adjacency& ring, std::span<const double> by_alpha);

}  // namespace selvedge

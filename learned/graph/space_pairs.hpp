#pragma once

#include <array>
#include <vector>

#include "collision/geometry/adjacency.hpp"
#include "learned/graph/feature_options.hpp"
#include "learned/graph/graph_state.hpp"

namespace selvedge {

// The lower vertex first.
using SpacePair = std::array<int, 2>;

// Memory between frames of one scene.
struct SpaceSearch {
  Adjacency mesh;
  double radius = 0;  // [m]; 0: not yet known
  std::vector<std::vector<SpacePair>> lists;
};

struct SpacePairs {
  std::vector<SpacePair> pairs;  // sorted, each once
  int beyond = 0;                // number left out above the limit
};

// All pairs of vertices closer than the radius and farther than 1e-7 m, found by a grid of hashed cells. Positions must
// be finite. The same bits on any number of threads.
SpacePairs find_space_pairs(const GraphScene&, const Points& x, const SpaceOptions&, SpaceSearch&);

}  // namespace selvedge

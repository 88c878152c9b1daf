#pragma once

#include <string>

#include "learned/graph/edge_features.hpp"
#include "learned/graph/pair_classes.hpp"
#include "learned/graph/space_pairs.hpp"

namespace selvedge {

// What was found and left out as a graph was made.
struct GraphReport {
  std::string refused;               // reason why there is no graph; empty: there is one
  std::vector<BodyPair> body_pairs;  // pairs with an edge
  int omitted_body_pairs = 0;        // pairs without one, because the nearest body vertex takes no part
  PairClasses cloth_pairs;           // pairs with an edge
  SpacePairs space_pairs;
  int cloth_pairs_beyond = 0;  // number left out above the limit, those farthest apart
};

// What the pairs of a graph depend on, for one scene and one set of options.
struct PairQuestion {
  Points x, mesh, ahead, body;  // as seen; `ahead`: velocities, where pinned vertices look ahead
  bool no_cloth_edges = false, no_space_edges = false;
};

// Memory between graphs of one scene and one set of options. It saves time and changes nothing.
struct GraphSearch {
  BodySearch body;
  ClothSearch cloth, future;
  SpaceSearch space;
  PairQuestion asked;  // of the last search, whose answer is kept: all passes of a frame ask the same
  GraphReport found;
  std::vector<int> body_vertices;
};

// Fills in the graph that a model with these options sees: topology and raw features. The first columns of each set
// (feature_options.hpp) are not normalised yet. The graph's memory is used again. The report refuses, and the graph is
// empty, where a position or velocity is not finite or too large to be squared. Throws Error for arrays of the wrong
// size.
void make_raw_graph(const GraphScene&, const RestGraph&, const GraphState&, const FeatureOptions&, const FeatureTables&,
                    GraphSearch&, Graph&, GraphReport&);

// Statistics of a set's first columns. In HOOD mesh and coarse edges share theirs.
const Statistics& statistics_for(const std::string& key, const FeatureOptions&, const FeatureTables&);

// Normalises a raw graph. Throws Error for tables of another width.
void normalise(const FeatureOptions&, const FeatureTables&, Graph&);

// For training: each set first adds to the sums and then is normalised by them; nodes come last (parity README, 10).
// The tables get these statistics, except those of the output.
void gather_and_normalise(const FeatureOptions&, FeatureSums<float>&, FeatureTables&, Graph&);

// Feature statistics for own training: summed over the states of a warm-up, noise included, then frozen. Sums start
// empty. Each graph is raw (make_raw_graph), with the accelerations that its output is trained for
// (target_accelerations). Columns of learned embeddings are summed too.
FeatureSums<double> empty_sums(const FeatureOptions&);
void gather(const FeatureOptions&, const Graph& raw, const FeatureRows& accelerations, FeatureSums<double>&);

// Sets statistics from the sums. Sets without rows keep theirs. A column that varied by 1e-4 of its root mean square or
// less gets deviation 1, so that its rounding and the gradient of an embedding stay small (parity README, 15).
void freeze_statistics(const FeatureSums<double>&, FeatureTables&);

// make_raw_graph and normalise together, for rollouts.
void make_graph(const GraphScene&, const RestGraph&, const GraphState&, const FeatureOptions&, const FeatureTables&,
                GraphSearch&, Graph&, GraphReport&);

}  // namespace selvedge

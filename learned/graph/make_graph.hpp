#pragma once

#include <string>

#include "learned/graph/edge_features.hpp"
#include "learned/graph/pair_classes.hpp"
#include "learned/graph/space_pairs.hpp"

namespace selvedge {

// What the making of a graph found and left out.
struct GraphReport {
  std::string refused;               // why there is no graph; empty: there is one
  std::vector<BodyPair> body_pairs;  // with an edge
  int omitted_body_pairs = 0;        // without one, for the nearest body vertex takes no part
  PairClasses cloth_pairs;           // with an edge
  SpacePairs space_pairs;
  int cloth_pairs_beyond = 0;  // left out, for they were more than the limit: those farthest apart
};

// Kept between frames of one scene. It saves time and changes nothing.
struct GraphSearch {
  BodySearch body;
  ClothSearch cloth, future;
  SpaceSearch space;
};

// Fills in the graph that a model with these options sees, using its memory again: topology and raw features, of which
// the first columns of each set (feature_options.hpp) are still to be normalised. The report refuses, and the graph is
// empty, where a position or velocity is not finite or so large that its square is not. Throws Error for arrays of the
// wrong size.
void make_raw_graph(const GraphScene&, const RestGraph&, const GraphState&, const FeatureOptions&, const FeatureTables&,
                    GraphSearch&, Graph&, GraphReport&);

// Statistics of a set's first columns. In HOOD mesh and coarse edges share theirs.
const Statistics& statistics_for(const std::string& key, const FeatureOptions&, const FeatureTables&);

// Normalises a raw graph. Throws Error for tables of another width.
void normalise(const FeatureOptions&, const FeatureTables&, Graph&);

// For training: one set after another first adds to the sums, then is normalised by what they hold now; nodes come last
// (parity README, 10). The tables' statistics, but not those of the output, are set to what the sums end with.
template <class Real>
void gather_and_normalise(const FeatureOptions&, FeatureSums<Real>&, FeatureTables&, Graph&);
template <class Real>
FeatureSums<Real> empty_sums(const FeatureOptions&);
// The member that sums up a set of edges.
BasicAccumulators<double>& sums_for(const std::string& key, const FeatureOptions&, FeatureSums<double>&);

// make_raw_graph and normalise: the one function for rollouts.
void make_graph(const GraphScene&, const RestGraph&, const GraphState&, const FeatureOptions&, const FeatureTables&,
                GraphSearch&, Graph&, GraphReport&);
Graph make_graph(const GraphScene&, const RestGraph&, const GraphState&, const FeatureOptions&, const FeatureTables&,
                 GraphSearch&, GraphReport&);

}  // namespace selvedge

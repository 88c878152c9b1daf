#pragma once

#include <span>

#include "learned/graph/body_pairs.hpp"
#include "learned/graph/integration.hpp"
#include "physics/solve/assembly.hpp"

namespace selvedge {

// The constant part of a scene that lengths depend on. All members are references.
struct LengthScene {
  const Elastic& elastic;
  const GraphScene& graph;
  const RestGraph& rest;
  const FeatureOptions& features;
  double thickness;  // of contact [m]
};

// Follows the output of a network beside the carried guess only as far as the solver's forces agree. `next` has where
// the whole output leads. The output is divided into a smooth and a rough part, and each part has a length from 0 to 1
// in each connected component: where the incremental potential of the frame is least, without contact, and linear
// between its forces at the guess and at the end of a part. Vertices within contact_reach of the body, by the pairs of
// the network's graph, are left out of the forces, since contact balances those. An output of zero changes nothing,
// and a component that touches the body everywhere takes the whole output.
void take_lengths(const LengthScene&, const GraphState&, std::span<const BodyPair>, AssemblyScratch&, NextCloth& next);

}  // namespace selvedge

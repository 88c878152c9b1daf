#pragma once

#include "learned/network/engine.hpp"

namespace selvedge::by_definition {

// What `infer` gives, by plain matrix products, node by node and edge by edge.
FeatureRows infer(const Architecture&, const NetworkWeights&, const Graph&, LatentTrace* = nullptr);

}  // namespace selvedge::by_definition

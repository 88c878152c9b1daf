#pragma once

#include <cstdint>

#include "learned/network/weights.hpp"

namespace selvedge {

// Weights at the start of training, drawn as in the published code: weights and biases of a layer uniform in +-1 /
// sqrt(inputs), embeddings normal with deviation 1, layer norms the identity. Statistics have mean 0 and deviation 1
// until they are gathered (learned/graph/make_graph.hpp). The same bits on every machine. The last
// layer of the decoder is scaled: by 0 or 0.01 in the fast recipe.
NetworkWeights initial_weights(const Architecture&, std::uint64_t seed, double last_layer_scale = 1);

}  // namespace selvedge

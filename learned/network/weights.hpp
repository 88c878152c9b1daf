#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "learned/graph/feature_tables.hpp"
#include "learned/network/architecture.hpp"

namespace selvedge {

// y = weight x + bias; weight is outputs x inputs, as in the published checkpoints.
struct AffineLayer {
  FeatureRows weight;
  std::vector<float> bias;
};

// Affine layers with max(0, x) between them, then a layer norm of the result (row 2 of the parity README; epsilon 1e-5)
// unless `scale` is empty.
struct Perceptron {
  std::vector<AffineLayer> layers;
  std::vector<float> scale, shift;
};

// Weights of one message-passing step. `edges` is parallel to MessageStep::edge_keys. An edge network reads target
// node, source node and edge. The node network reads its node, then the sums in the order of the keys.
struct StepWeights {
  std::vector<Perceptron> edges;
  Perceptron node;
};

// All learned numbers of a network. `encoders` is parallel to Architecture::encoders.
struct NetworkWeights {
  Perceptron node_encoder;
  std::vector<Perceptron> encoders;
  std::vector<StepWeights> steps;
  Perceptron decoder;
  FeatureTables tables;  // statistics and embeddings
};

// One array of the weights, row by row: a matrix, or a vector with columns = 1. `name` is its path in the weight file,
// such as "steps/03/edges/mesh_edge/layer0/weight".
struct WeightArray {
  std::string name;
  float* data = nullptr;
  int rows = 0, columns = 1;
  int inputs = 0;       // inputs of its layer; 0: it belongs to no layer
  bool trained = true;  // false: statistics
};

// Arrays in the architecture's shapes: weights and biases zero, layer norms the identity, deviations one.
NetworkWeights blank_weights(const Architecture&);

// Pointers to every array of the weights, whose shapes must be the architecture's, in a fixed order.
std::vector<WeightArray> weight_arrays(const Architecture&, NetworkWeights& weights);

// Throws Error that names the first array whose shape is not the architecture's. `where` names the file.
void check_weights(const Architecture&, const NetworkWeights&, const std::string& where);

// Random weights, for tests and for new parts of widened networks: uniform in +-sqrt(3 / inputs), with biases in +-0.1
// and embeddings in +-1. Layer norms are the identity, statistics have mean 0 and deviation 1. The same bits on every
// machine.
NetworkWeights random_weights(const Architecture&, std::uint64_t seed);

// Weights at the start of training, drawn as in the published code: weights and biases of a layer uniform in +-1 /
// sqrt(inputs), embeddings normal with deviation 1, layer norms the identity. Statistics have mean 0 and deviation 1
// until they are gathered (learned/graph/make_graph.hpp). The same bits on every machine. The last
// layer of the decoder is scaled: by 0 or 0.01 in the fast recipe.
NetworkWeights initial_weights(const Architecture&, std::uint64_t seed, double last_layer_scale = 1);

}  // namespace selvedge

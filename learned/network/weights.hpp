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

// Affine layers with max(0, x) between them, then, unless `scale` is empty, a layer norm of the result (row 2 of the
// parity README; epsilon 1e-5).
struct Perceptron {
  std::vector<AffineLayer> layers;
  std::vector<float> scale, shift;
};

// Weights of one message-passing step. `edges` stands parallel to MessageStep::edge_keys. An edge network reads target
// node, source node, edge; the node network its node, then the sums in the order of the keys.
struct StepWeights {
  std::vector<Perceptron> edges;
  Perceptron node;
};

// All that a network has learned, beside its architecture. `encoders` stands parallel to Architecture::encoders.
struct NetworkWeights {
  Perceptron node_encoder;
  std::vector<Perceptron> encoders;
  std::vector<StepWeights> steps;
  Perceptron decoder;
  FeatureTables tables;  // statistics and embeddings
};

// One array of the weights, row by row: a matrix rows x columns, or a vector with columns = 1. `name` is its path in
// the weight file, such as "steps/03/edges/mesh_edge/layer0/weight".
struct WeightArray {
  std::string name;
  float* data = nullptr;
  int rows = 0, columns = 1;
  int inputs = 0;       // of the layer that it belongs to; 0 elsewhere
  bool trained = true;  // false for statistics
};

// Arrays of the shapes that the architecture asks for: weights and biases zero, layer norms the identity, deviations
// one.
NetworkWeights blank_weights(const Architecture&);

// Every array of weights that have the architecture's shapes, in a fixed order, pointing into `weights`.
std::vector<WeightArray> weight_arrays(const Architecture&, NetworkWeights& weights);

// Throws Error that names the first array whose shape is not what the architecture asks for; `where` is its file.
void check_weights(const Architecture&, const NetworkWeights&, const std::string& where);

// Weights for tests and for the start of training: uniform in +-sqrt(3 / inputs), biases in +-0.1, embeddings in
// +-1; layer norms the identity, statistics mean 0 and deviation 1. The same bits on every machine.
NetworkWeights random_weights(const Architecture&, std::uint64_t seed);

}  // namespace selvedge

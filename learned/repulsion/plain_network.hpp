#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "learned/network/weights.hpp"

namespace selvedge {

// The activation between layers: max(0, .), or log(1 + exp(beta .)) / beta.
enum class Bend { rectified, softplus };

// A multi-layer perceptron without a graph: affine layers with an activation between them and none behind the last.
struct PlainNetwork {
  std::vector<AffineLayer> layers;
  Bend bend = Bend::rectified;
  double beta = 100;  // of softplus
  // This layer reads the first `again_columns` of the inputs a second time, behind the results of the layer before.
  int again_layer = -1;  // -1: none does
  int again_columns = 0;

  int inputs() const { return static_cast<int>(layers.front().weight.cols()) - (again_layer == 0 ? again_columns : 0); }
  int outputs() const { return static_cast<int>(layers.back().bias.size()); }
};

struct PlainShape {
  int inputs = 0;
  std::vector<int> outputs;  // of each layer
  Bend bend = Bend::rectified;
  double beta = 100;
  int again_layer = -1, again_columns = 0;
};

// Weights uniform in +-sqrt(6 / inputs), biases zero; the same bits on every machine. A layer without inputs is refused
// (Error).
PlainNetwork make_plain_network(const PlainShape&, std::uint64_t seed);
long long parameter_count(const PlainNetwork&);
// All parameters, layer by layer: weights row by row, then biases.
std::vector<float> parameters_of(const PlainNetwork&);
void set_parameters(std::span<const float>, PlainNetwork&);  // as many as it has (assert)

// Rows of inputs to rows of outputs. Chunks of rows are independent: any number of threads gives the same bits.
FeatureRows evaluate(const PlainNetwork&, const FeatureRows& inputs);

// Outputs, and for a network of one output its gradient by the first `columns` inputs, a row an input row.
struct ValueAndGradient {
  FeatureRows value, gradient;
};
ValueAndGradient evaluate_with_gradient(const PlainNetwork&, const FeatureRows& inputs, int columns);

// One direction in the space of the inputs goes along with each row: outputs, and their derivatives in it.
struct ValueAndTangent {
  FeatureRows value, tangent;
};
ValueAndTangent evaluate_with_tangent(const PlainNetwork&, const FeatureRows& inputs, const FeatureRows& directions);

// Derivatives of a loss L with respect to outputs y and to their derivatives y' in the directions: dL/dy and dL/dy'.
struct PlainAdjoints {
  FeatureRows value, tangent;  // tangent: no rows where the loss knows no derivatives
};

// Gradient of a loss by the parameters, in the order of parameters_of, and by the inputs. `directions` have no rows
// where the loss knows no derivatives of the outputs. Sums over rows are taken by chunks in a fixed order.
struct PlainGradients {
  std::vector<float> parameters;
  FeatureRows inputs;
};
PlainGradients backward(const PlainNetwork&, const FeatureRows& inputs, const FeatureRows& directions,
                        const PlainAdjoints&);

}  // namespace selvedge

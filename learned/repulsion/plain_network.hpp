#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "learned/network/weights.hpp"

namespace selvedge {

// The activation between layers: max(0, .), or log(1 + exp(beta .)) / beta.
enum class Bend { rectified, softplus };

// A multi-layer perceptron without a graph: affine layers with an activation between them.
struct PlainNetwork {
  std::vector<AffineLayer> layers;
  Bend bend = Bend::rectified;
  double beta = 100;  // of softplus
  // This layer reads the first `again_columns` inputs again, after the results of the layer before.
  int again_layer = -1;  // -1: none
  int again_columns = 0;

  int inputs() const { return static_cast<int>(layers.front().weight.cols()) - (again_layer == 0 ? again_columns : 0); }
  int outputs() const { return static_cast<int>(layers.back().bias.size()); }
};

struct PlainShape {
  int inputs = 0;
  std::vector<int> outputs;  // one per layer
  Bend bend = Bend::rectified;
  double beta = 100;
  int again_layer = -1, again_columns = 0;
};

// Weights are uniform in +-sqrt(6 / inputs), biases zero. The same bits on every machine. Throws Error for a layer
// without inputs.
PlainNetwork make_plain_network(const PlainShape&, std::uint64_t seed);
long long parameter_count(const PlainNetwork&);
// All parameters, layer by layer: weights row by row, then biases.
std::vector<float> parameters_of(const PlainNetwork&);
void set_parameters(std::span<const float>, PlainNetwork&);  // asserts that their number fits

// Rows of inputs to rows of outputs. Any number of threads gives the same bits, because chunks of rows are independent.
FeatureRows evaluate(const PlainNetwork&, const FeatureRows& inputs);

// Outputs of a network with one output, and their gradient by the first `columns` inputs, one row per input row.
struct ValueAndGradient {
  FeatureRows value, gradient;
};
ValueAndGradient evaluate_with_gradient(const PlainNetwork&, const FeatureRows& inputs, int columns);

// Derivatives of a loss L by outputs y and by their derivatives y' along one direction per row in the space of the
// inputs: dL/dy and dL/dy'.
struct PlainAdjoints {
  FeatureRows value, tangent;  // tangent has no rows if the loss has no y'
};

// Gradient of a loss by the parameters, in the order of parameters_of, and by the inputs. `directions` have no rows if
// the loss has no y'. Sums over rows are taken by chunks in a fixed order.
struct PlainGradients {
  std::vector<float> parameters;
  FeatureRows inputs;
};
PlainGradients backward(const PlainNetwork&, const FeatureRows& inputs, const FeatureRows& directions,
                        const PlainAdjoints&);

// Adam (Kingma and Ba 2015, algorithm 1) for a plain network. Moments are in the order of parameters_of.
struct PlainAdam {
  double rate = 1e-5, beta1 = 0.9, beta2 = 0.999, epsilon = 1e-8;
  double decay = 0;  // weight decay, times the rate (Loshchilov and Hutter 2019)
  long long steps = 0;
  std::vector<float> first, second;
};

// Takes one step. Returns false and changes nothing if the gradient is not finite.
bool take_step(PlainAdam&, std::span<const float> gradient, PlainNetwork&);

}  // namespace selvedge

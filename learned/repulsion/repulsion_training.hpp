#pragma once

#include "learned/repulsion/repulsive_layer.hpp"

namespace selvedge {

// The Jacobian that takes gradients back through the layer (repulsive_layer.hpp). If a deep vertex was pushed in
// another direction than its gradient, that direction counts as constant.
enum class LayerGradient { full, frozen };

// Equations 7 to 9: reconstruction * sum |x' - truth|^2 + collision * sum max(-f(x'), 0). Lengths are in `unit`, which
// the paper does not give.
struct RepulsionLossOptions {
  double reconstruction = 1.5, collision = 0.5;
  double unit = 1;  // [m]
  LayerGradient gradient = LayerGradient::full;
};

struct RepulsionLosses {
  double reconstruction = 0, collision = 0, total = 0;  // the first two without weights
  Points by_x;                                          // derivative of the total by the layer's input [1/m]
  std::vector<double> by_alpha;  // derivative by the scales of the pushed vertices, in their order
};

// Losses of a layer that was run without rechecks. `judge` gives the distance f in the loss: accurate distances in the
// settings accurate and hybrid, the network's in approximate. A vertex outside gets no gradient of the collision loss.
RepulsionLosses repulsion_losses(const Repelled&, const Points& truth, const AskDistance& judge,
                                 const RepulsionLossOptions&);

// Gradient of a loss by the parameters of each part of a scale network, in the order of parameters_of.
struct ScaleGradients {
  std::vector<float> h, k, g;
};

// `by_alpha` is the derivative of the loss by the scale of each vertex.
ScaleGradients scale_gradients(const ScaleNetwork&, std::span<const float> inputs, std::span<const int> vertices,
                               std::span<const double> distances, std::span<const double> by_alpha);

}  // namespace selvedge

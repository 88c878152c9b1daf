#pragma once

#include "learned/repulsion/repulsive_layer.hpp"

namespace selvedge {

// Which Jacobian takes gradients back through the layer (repulsive_layer.hpp). Where a deep vertex was pushed in
// another direction than its gradient, that direction counts as constant.
enum class LayerGradient { full, frozen };

// Equations 7 to 9: reconstruction * sum |x' - truth|^2 + collision * sum max(-f(x'), 0), lengths in `unit`. The paper
// gives none.
struct RepulsionLossOptions {
  double reconstruction = 1.5, collision = 0.5;
  double unit = 1;  // [m]
  LayerGradient gradient = LayerGradient::full;
};

struct RepulsionLosses {
  double reconstruction = 0, collision = 0, total = 0;  // the first two without weights
  Points by_x;                                          // derivative of the total by what the layer read [1/m]
  std::vector<double> by_alpha;                         // by the scales of the pushed vertices, in their order
};

// Of a layer that was run without rechecks. `judge` gives the distance f in the loss: accurate distances in the
// settings accurate and hybrid, the network's in approximate. A vertex outside gets no gradient of the collision loss.
RepulsionLosses repulsion_losses(const Repelled&, const Points& truth, const AskDistance& judge,
                                 const RepulsionLossOptions&);

// Gradient of a loss by all parameters of a scale network, in the order of parameters_of for each part.
struct ScaleGradients {
  std::vector<float> h, k, g;
};

// `by_alpha`: derivative of the loss by the scale of each vertex.
ScaleGradients scale_gradients(const ScaleNetwork&, std::span<const float> inputs, std::span<const int> vertices,
                               std::span<const double> distances, std::span<const double> by_alpha);

}  // namespace selvedge

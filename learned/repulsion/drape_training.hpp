#pragma once

#include <string>

#include "learned/repulsion/drape_network.hpp"
#include "learned/repulsion/neighbour_scale.hpp"
#include "learned/repulsion/plain_adam.hpp"
#include "learned/repulsion/repulsion_training.hpp"

namespace selvedge {

// A network for drapes and the scales of the layer behind it. Unused scale networks have no layers.
struct DrapeModel {
  DrapeNetwork drape;
  ScaleNetwork scale;
  NeighbourScale neighbours{};
  bool has_scale() const { return !scale.g.layers.empty(); }
  bool has_neighbours() const { return !neighbours.end.layers.empty(); }
};

// The trained parts of a model by name: the perceptron, the scale networks, then kernels and mixtures of the mesh
// layers. Absent parts are left out.
struct DrapePart {
  std::string name;
  PlainNetwork* network;
  bool scales = false;  // it belongs to the networks of scales
};
std::vector<DrapePart> parts_of(DrapeModel&);

// The layer behind the network, and the loss of its result.
struct DrapeRecipe {
  bool layer = false;  // with the model's scales, or `alpha` without them
  double alpha = 1;
  RepulsionOptions repulsion;  // without rechecks where a network is trained
  RepulsionLossOptions loss;   // collision 0: no loss 9, and `judge` is not called
};

// A training drape with two distances of its body: `layer` is read by the layer, `judge` by the loss.
struct DrapeLesson {
  const DrapeCase* drape = nullptr;
  AskDistance layer, judge;
};

// The positions after the layer; unchanged if the recipe has no layer.
Repelled behind_drape(const DrapeModel&, const DrapeCase&, const Points& x, const Adjacency& ring,
                      const AskDistance& ask, const DrapeRecipe&);

// Mean over the lessons of the losses 7 to 9, and its gradient by all parameters.
struct DrapeGradients {
  double total = 0, reconstruction = 0, collision = 0;
  double pushed = 0, alpha = 0;           // vertices a drape, and their mean scale
  std::vector<std::vector<float>> parts;  // of each of parts_of, in the order of parameters_of; empty: of none pushed
};
DrapeGradients drape_gradients(const DrapeModel&, std::span<const DrapeLesson>, const Adjacency& ring,
                               const DrapeRecipe&);

// The optimiser: Adam for each part of a model.
struct DrapeAdam {
  std::vector<PlainAdam> parts;
  double scale_rate = 1;  // times the rate, for the networks of scales
  double decay = 0;       // of the first part
};
// One step of the optimiser. False if a gradient is not finite; then nothing has changed.
bool take_step(DrapeAdam&, const DrapeGradients&, double rate, DrapeModel&);

}  // namespace selvedge

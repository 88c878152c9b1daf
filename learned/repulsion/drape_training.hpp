#pragma once

#include <string>

#include "learned/repulsion/drape_network.hpp"
#include "learned/repulsion/neighbour_scale.hpp"
#include "learned/repulsion/repulsion_training.hpp"

namespace selvedge {

// A network for drapes and the scales of the layer after it. Unused scale networks have no layers.
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
  bool scales = false;  // one of the scale networks
};
std::vector<DrapePart> parts_of(DrapeModel&);

// The layer after the network, and the loss of its result.
struct DrapeRecipe {
  bool layer = false;  // whether there is one, with the model's scales or else `alpha`
  double alpha = 1;
  RepulsionOptions repulsion;  // without rechecks in training
  RepulsionLossOptions loss;   // collision 0: no loss 9 and no call of `judge`
};

// A training drape with two distances of its body: the layer reads `layer`, and the loss reads `judge`.
struct DrapeLesson {
  const DrapeCase* drape = nullptr;
  AskDistance layer, judge;
};

// The positions after the layer; unchanged if the recipe has no layer.
Repelled behind_drape(const DrapeModel&, const DrapeCase&, const Points& x, const Adjacency& ring,
                      const AskDistance& ask, const DrapeRecipe&);

// The mean of the losses 7 to 9 over the lessons, and its gradient by all parameters.
struct DrapeGradients {
  double total = 0, reconstruction = 0, collision = 0;
  double pushed = 0, alpha = 0;           // pushed vertices per drape, and their mean scale
  std::vector<std::vector<float>> parts;  // as parts_of, in the order of parameters_of; empty: no vertex was pushed
};
DrapeGradients drape_gradients(const DrapeModel&, std::span<const DrapeLesson>, const Adjacency& ring,
                               const DrapeRecipe&);

// The optimiser: Adam for each part of a model.
struct DrapeAdam {
  std::vector<PlainAdam> parts;
  double scale_rate = 1;  // factor of the rate for the scale networks
  double decay = 0;       // weight decay of the first part
};
// Takes one step. Returns false and changes nothing if a gradient is not finite.
bool take_step(DrapeAdam&, const DrapeGradients&, double rate, DrapeModel&);

}  // namespace selvedge

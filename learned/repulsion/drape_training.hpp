#pragma once

#include <string>

#include "learned/repulsion/drape_network.hpp"
#include "learned/repulsion/neighbour_scale.hpp"
#include "learned/repulsion/plain_adam.hpp"
#include "learned/repulsion/repulsion_training.hpp"

namespace selvedge {

// A network for drapes and the layer behind it. Networks of scales that it does without have no layers.
struct DrapeModel {
  DrapeNetwork drape;
  ScaleNetwork scale;
  NeighbourScale neighbours{};
  bool has_scale() const { return !scale.g.layers.empty(); }
  bool has_neighbours() const { return !neighbours.end.layers.empty(); }
};

// Its trained parts by name: the perceptron, the networks of scales, then kernels and mixtures of the mesh layers.
// Those of a model without them are left out.
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
  RepulsionLossOptions loss;   // collision 0: there is no loss 9, and the judge is not asked
};

// A drape to learn from, with two distances of its body: one for the layer, one for the loss.
struct DrapeLesson {
  const DrapeCase* drape = nullptr;
  AskDistance layer, judge;
};

// What the layer makes of positions; without one, the positions.
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

// Adam of each of a model's parts.
struct DrapeAdam {
  std::vector<PlainAdam> parts;
  double scale_rate = 1;  // times the rate, for the networks of scales
  double decay = 0;       // of the first part
};
// False: a gradient is not finite, and nothing has changed.
bool take_step(DrapeAdam&, const DrapeGradients&, double rate, DrapeModel&);

}  // namespace selvedge

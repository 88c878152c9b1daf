#pragma once

#include <memory>

#include "collision/distance/edge_pass.hpp"
#include "learned/repulsion/neighbour_scale.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

struct RefuOptions {
  RepulsionOptions repulsion{.recheck = 8, .margin = 1e-4, .most_beyond = 0.01, .order = {.reach = 0.03}};
  double alpha = 1;                                  // scale of every vertex, unless there are `neighbours`
  std::shared_ptr<const NeighbourScale> neighbours;  // networks that predict the scale of each vertex
  EdgePassOptions edge_pass{.rounds = 0, .count = false};
  bool budget = true;  // skips queries of vertices that provably stay outside; saves time and changes nothing else
};

// The repulsive layer after any stepper. It pushes vertices out that a step leaves inside a closed obstacle
// (repulsive_layer.hpp), by accurate distances to the union of the obstacles. Pinned vertices stay. The push adds no
// speed, and removes the part of the vertex' velocity that leads back in. If nothing is inside, or the step is
// rejected, the result of the inner stepper is returned bit for bit. The motion to a pushed state and the state are
// audited, and an integrator of two steps starts again from it. Layers see each other over 1.5 times the longest edge,
// and over LayerOrder::span at least.
//
// Without closed obstacles the inner stepper is returned. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_refu_stepper(const Scene&, std::unique_ptr<Stepper>, const RefuOptions& = {});

}  // namespace selvedge

#pragma once

#include <memory>

#include "collision/distance/edge_pass.hpp"
#include "learned/repulsion/neighbour_scale.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

struct RefuOptions {
  RepulsionOptions repulsion{.recheck = 8, .margin = 1e-4, .most_beyond = 0.01, .order = {.reach = 0.03}};
  double alpha = 1;                                  // of every vertex, where there are no `neighbours`
  std::shared_ptr<const NeighbourScale> neighbours;  // networks that say it of each
  EdgePassOptions edge_pass{.rounds = 0, .count = false};
  bool budget = true;  // vertices that provably stay outside are not asked; it changes the time and nothing else
};

// The repulsive layer behind any stepper: vertices that a step leaves inside a closed obstacle are pushed out
// (repulsive_layer.hpp), by accurate distances to the unions of the obstacles. Pinned vertices stay. The push adds no
// speed, and takes away the part of a pushed vertex's velocity that would bring it back in. What the inner stepper has
// made is returned bit for bit where nothing is inside, and rejected steps always. A pushed state is audited anew, and
// an integrator of two steps begins anew from it.
//
// Without closed obstacles the inner stepper is returned. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_refu_stepper(const Scene&, std::unique_ptr<Stepper>, const RefuOptions& = {});

}  // namespace selvedge

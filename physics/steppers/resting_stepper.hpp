#pragma once

#include <memory>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// How long each cloth has been at rest, with which wind and gravity, and what contact exerts on it then.
struct Rest {
  std::vector<double> seconds;  // one per cloth; empty: not known
  Points place;                 // positions, all cloths one after the other
  Vec3 wind = Vec3::Zero(), acceleration = Vec3::Zero();
  std::shared_ptr<const ContactForces> forces = {};  // of the last step; null: not asked for
};

// The resting stepper keeps this in State::memory.
Rest rest_of(const State&);
void remember(const Rest&, State&);

// When a cloth rests. Members are described where keys are bound to them: pipeline/scene/config_run.cpp.
struct RestingOptions {
  double still_edges = 0.005, still_seconds = 0.5;
};

// A stepper that leaves out every cloth that rests: none of its vertices has moved for a while, its pins, wind and
// gravity do not change, and nothing that moves comes near it. Cloths that springs join rest together or not at all.
// The other cloths are a scene of their own, stepped by the stepper that `make` makes of it. If no cloth rests, or with
// extras, `whole` makes the step. If a resting cloth could meet a moving one after all, the step is taken again with
// both. A cloth on a moving one does not rest, and in a tangled state none rests. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_resting_stepper(const Scene&, MakeStepper make, std::unique_ptr<Stepper> whole,
                                              const RestingOptions& = {});

}  // namespace selvedge

#pragma once

#include <memory>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// How long each cloth has been where it is, and in which wind and under which gravity.
struct Rest {
  std::vector<double> seconds;  // one a cloth; empty: not known
  Points place;                 // about where, all cloths on end
  Vec3 wind = Vec3::Zero(), acceleration = Vec3::Zero();
};

// What the resting stepper remembers in State::memory.
Rest rest_of(const State&);
void remember(const Rest&, State&);

struct RestingOptions {
  double still_edges = 0.005;  // Cloth rests if no vertex moves by more than this many mean edges
  double still_seconds = 0.5;  // in this time [s].
};

// A stepper that leaves out of a step every cloth that rests: for a while no vertex of it has moved, neither its pins
// nor wind or gravity change, and nothing that moves comes near it. Cloths that springs join rest together or not at
// all. The other cloths are a scene of their own, stepped by what `make` makes of it; all of them are stepped by
// `whole`, and so are steps with extras. Where cloths could meet after all the step is taken again with both. A cloth
// on one that moves does not rest, and in a tangled state none rests. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_resting_stepper(const Scene&, MakeStepper make, std::unique_ptr<Stepper> whole,
                                              const RestingOptions& = {});

}  // namespace selvedge

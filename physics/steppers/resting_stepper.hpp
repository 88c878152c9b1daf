#pragma once

#include <functional>
#include <memory>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

using MakeStepper = std::function<std::unique_ptr<Stepper>(const Scene&)>;

// A stepper that leaves out of a step every cloth that rests: for half a second no vertex of it has moved by more
// than 0.005 mean edges, neither its pins nor wind or gravity change, and nothing that moves comes near it. Cloths that
// springs join rest together or not at all. The other cloths are a scene of their own, stepped by what `make` makes of
// it. Where cloths could meet after all the step is taken again with both. A cloth rests on one that moves never, and a
// tangled state has none that rest. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_resting_stepper(const Scene&, MakeStepper make);

}  // namespace selvedge

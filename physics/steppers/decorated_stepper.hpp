#pragma once

#include <memory>

#include "physics/recovery/recovery_options.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"
#include "physics/steppers/conventional_stepper.hpp"
#include "physics/steppers/resting_stepper.hpp"

namespace selvedge {

struct Decorations {
  bool rest = false;  // leave out cloths that rest, if the stepper allows it
  bool cut = false;   // states may have triangles cut out
  RecoveryOptions recovery = {};
  RestingOptions resting = {};
};

// A stepper that `bare` makes of the scene, or of a part of it, with the decorators round it: from outside to inside
// cutting, resting, recovering. The recovering one needs a stepper that honours extras. Decorators that know more than
// the scene stand round all of these: the repulsive layer (learned), and followers (following_stepper.hpp).
std::unique_ptr<Stepper> decorated(const Scene&, const MakeStepper& bare, const Decorations& = {});

// Makes bare conventional steppers with these options, for `decorated`.
MakeStepper conventional_maker(const ConventionalOptions&);

// The conventional stepper with recovery.
std::unique_ptr<Stepper> make_recovering_conventional_stepper(const Scene&, const ConventionalOptions& = {});

}  // namespace selvedge

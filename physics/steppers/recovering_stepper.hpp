#pragma once

#include <memory>

#include "physics/recovery/recovery_options.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// Where everything was when the cloth was clean last.
struct LastClean {
  Points x;  // no rows: it never was
  std::vector<Points> obstacles;
};

// The recovering stepper keeps this in State::memory while dressed cloth is not clean.
LastClean last_clean(const State&);
void remember(const LastClean&, State&);

// A stepper for starts that are tangled, and for bodies that cross themselves (parting.hpp). Dressed cloth that a limb
// has gone through is put on again, other tangled cloth is parted, and `inner` steps from there. By extras `inner`
// learns what contact has to leave alone, and gets terms that keep separations and draw cloth to its skinned targets.
// From clean states, with bodies that do not cross themselves, the step is that of `inner`. Extras of the caller are
// passed on too. Throws Error for an inner stepper that does not honour extras. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_recovering_stepper(const Scene&, std::unique_ptr<Stepper> inner,
                                                 const RecoveryOptions& = {});

}  // namespace selvedge

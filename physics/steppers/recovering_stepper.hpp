#pragma once

#include <memory>

#include "physics/recovery/recovery_options.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// Where everything was when cloth that is tangled now was clean last.
struct LastClean {
  Points x;  // without rows: it never was
  std::vector<Points> obstacles;
};

// What the recovering stepper remembers in State::memory, of worn cloth that is not clean.
LastClean last_clean(const State&);
void remember(const LastClean&, State&);

// A stepper for starts that are tangled, and for bodies that cross themselves (parting.hpp): worn cloth that a limb has
// gone through is put on again, what else is tangled is parted, and `inner` steps from there. It is told what contact
// has to leave alone, and gets terms that keep what was gained and draw cloth to where it is worn. From clean states
// with bodies free of themselves the step is that of `inner`. Extras are handed on beside its own. Throws Error for an
// inner stepper that honours none. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_recovering_stepper(const Scene&, std::unique_ptr<Stepper> inner,
                                                 const RecoveryOptions& = {});

}  // namespace selvedge

#pragma once

#include <memory>
#include <vector>

#include "learned/network/weights.hpp"
#include "learned/steppers/network_device.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

struct LearnedOptions {
  bool settle = false;  // the roll-out of a network with a start flag begins with a settling pass too
  std::vector<int> omitted_body_vertices = {};  // of the obstacles, on end: they get no edges, as hands in HOOD
  std::vector<int> centres = {};  // from which coarse levels are made, one a piece at most; others are chosen
  NetworkDevice device = NetworkDevice::cpu;
};

// Of the stepper with a network of this architecture.
StepperTraits learned_traits(const Architecture&);

// A network of HOOD's or ContourCraft's kind makes each frame of 1/30 s. Where a roll-out begins, HOOD first takes its
// relaxation frame (parity README, 18): the cloth is pushed out of the body and falls to rest in a pass that counts 1/3
// s while the body stands still. ContourCraft does so, with its flag is_init and without cloth-cloth edges, only where
// the options ask for it.
//
// A network with inputs for accelerations (SENC) is shown those of the drive and of the wind. Others know no wind, and
// no gravity but the one that they were trained in; none knows springs or damping. The stepper neither detects nor
// undoes penetrations: the audits of motion and of positions find and report them. A state or a prediction that is not
// finite, or beyond 1000 km, rejects the step with the reason `not_finite`.
//
// Keeps a reference to the scene, and copies what it needs of the weights. Throws Error for weights that are not of the
// architecture's shapes, for inputs that the stepper does not make, and for a scene that is no graph
// (make_rest_graph) or lacks an omitted vertex, and where the options ask for a device that is not there. A step throws
// Error for another time step than 1/30 s.
std::unique_ptr<Stepper> make_learned_stepper(const Scene&, const Architecture&, const NetworkWeights&,
                                              const LearnedOptions& = {});

}  // namespace selvedge

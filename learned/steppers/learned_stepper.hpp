#pragma once

#include <memory>
#include <vector>

#include "learned/network/weights.hpp"
#include "learned/steppers/network_device.hpp"
#include "physics/scene/features.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

struct LearnedOptions {
  bool settle = false;                          // a network with a start flag begins with a settling pass too
  std::vector<int> omitted_body_vertices = {};  // indices over all obstacles: no edges, as for hands in HOOD
  std::vector<int> centres = {};                // centres of coarse levels, at most one per piece; others are chosen
  NetworkDevice device = NetworkDevice::cpu;
  NetworkNumbers numbers = NetworkNumbers::float32;  // of the CPU's kernels
  bool step_lengths = true;  // follows an output beside the carried guess as far as the solver's forces agree
};

// Whether a roll-out may begin with a settling pass: a network that adds to the carried guess takes the cloth as
// it is.
bool may_settle(const Architecture&);

// The traits of the stepper with such a network.
StepperTraits learned_traits(const Architecture&);

// A network of HOOD's or ContourCraft's kind makes each frame of 1/30 s. Where a roll-out begins, HOOD first takes its
// settling frame (parity README, 18): the cloth is pushed out of the body and falls to rest in a pass that counts 1/3
// s while the body stands still. ContourCraft does so, with its flag is_init and without cloth-cloth edges, only where
// the options ask for it.
//
// A network whose output is added to the carried guess (OutputBase::carried) never settles, keeps the memory of that
// guess beside its own, and with an output of zero makes the carried guess.
//
// A network with inputs for accelerations (SENC) gets those of the drive and of the wind. Others know no wind, and no
// gravity but that of their training. None knows springs or damping. The stepper neither detects nor undoes
// penetrations; the audits of motion and of positions report them. It rejects a step with the reason `not_finite` where
// a state or a prediction is not finite or beyond 1000 km.
//
// Keeps a reference to the scene, and copies the weights. Throws Error for weights in other shapes than the
// architecture's, for inputs that the stepper does not make, for a scene that gives no graph (make_rest_graph) or lacks
// an omitted vertex, and for a missing device. A step throws Error for a time step other than 1/30 s.
std::unique_ptr<Stepper> make_learned_stepper(const Scene&, const Architecture&, const NetworkWeights&,
                                              const LearnedOptions& = {});

// Lines for `selvedge plan`: inputs of the network that the scene uses or leaves out, and parts of the scene that the
// network ignores.
std::vector<PlanLine> learned_plan_lines(const Scene&, const Architecture&, const LearnedOptions&);

}  // namespace selvedge

#pragma once

#include <memory>

#include "learned/network/weights_hdf5.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// The network that the stepper `learned` runs. Throws Error where the scene names none, and whatever read_weight_file
// does.
WeightFile read_learned_weights(const Setup&);

// The only switch over kinds of steppers. Keeps a reference to the setup's scene. Throws Error for an unknown kind, and
// for a scene that the stepper does not take: another time step than its own, triangles that are cut out.
std::unique_ptr<Stepper> make_stepper(const Setup&);

}  // namespace selvedge

#pragma once

#include "learned/gradients/training_network.hpp"
#include "learned/network/packed_network.hpp"

namespace selvedge {

// Weights as the kernels read them.
struct TrainingLayout {
  PackedNetwork forward, backward;
};

}  // namespace selvedge

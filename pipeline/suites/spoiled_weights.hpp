#pragma once

#include <string>
#include <vector>

#include "learned/network/weights_hdf5.hpp"

namespace selvedge {

// Faults that are put into a weight file for runs that a stepper has to survive. nan: every bias of the decoder is not
// a number; random: weights of an untrained network with the file's statistics; zero: the network returns zeros; huge:
// it returns 1e6.
const std::vector<std::string>& weight_faults();

// `fault` is one of them (assert).
WeightFile spoiled_weights(WeightFile, const std::string& fault);

}  // namespace selvedge

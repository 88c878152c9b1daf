#pragma once

#include <string>

#include "learned/graph/feature_tables.hpp"
#include "learned/network/weights.hpp"
#include "pipeline/processes/processes.hpp"

namespace selvedge {

// The gradients of each process are the mean over its samples, of which it may have none. They become the mean over the
// samples of all processes, with the same bits on each (add_up). Returns the number of all samples; without any the
// gradients are zero. Throws SharedFailure.
int average_gradients(Processes&, const Architecture&, int samples, NetworkWeights& gradients);

// Adds what every process has gathered since the last call to `all`, which is the same on each. Sets that have had
// `most_updates` stay. Throws SharedFailure.
void add_statistics(Processes&, const FeatureSums<double>& gathered, FeatureSums<double>& all);

// Throws SharedFailure where the weights of the processes differ in a bit.
void check_same_weights(Processes&, const Architecture&, const NetworkWeights&, const std::string& where);

}  // namespace selvedge

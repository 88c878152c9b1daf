#pragma once

#include <string>
#include <vector>

#include "pipeline/scene/setup.hpp"
#include "pipeline/scene/trained_with_yaml.hpp"

namespace selvedge {

// A sentence for every quantity of every cloth that is far from training: a material's number by a factor of more than
// three, the mean edge length by more than one and a half. Networks do not extrapolate: too stiff a cloth slides off
// the body, and one with edges of half the length stretches to a multiple.
std::vector<std::string> unlike_training(const Scene&, const TrainedWith&);

// The same for a scene whose stepper runs a network, with other causes of wrong frames: gravity that the network does
// not take as input, and weights that are not finite. Empty for all other scenes. Reads the weight file and throws its
// errors.
std::vector<std::string> network_warnings(const Setup&);

}  // namespace selvedge

#pragma once

#include <string>
#include <vector>

#include "pipeline/scene/setup.hpp"
#include "pipeline/scene/trained_with_yaml.hpp"

namespace selvedge {

// A sentence for every quantity of every cloth that is far from training: of a material over three times as large or
// under a third, of the edges' mean length one and a half times. Networks do not extrapolate: too stiff a cloth slides
// off the body, and one with edges of half the length stretches to a multiple.
std::vector<std::string> unlike_training(const Scene&, const TrainedWith&);

// The same for a scene whose stepper runs a network, and what else makes its frames wrong: gravity that it does not
// see, numbers of its own that are not finite. Empty for all other scenes. Reads the weight file; throws its errors.
std::vector<std::string> network_warnings(const Setup&);

}  // namespace selvedge

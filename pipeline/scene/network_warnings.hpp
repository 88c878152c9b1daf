#pragma once

#include <string>
#include <vector>

#include "learned/network/weights_hdf5.hpp"
#include "physics/scene/scene.hpp"
#include "pipeline/weights/trained_with_yaml.hpp"

namespace selvedge {

// A sentence for every quantity of every cloth that is far from training: of a material over three times as large or
// under a third, of the edges' mean length one and a half times. Networks do not extrapolate: too stiff a cloth slides
// off the body, and one with edges of half the length stretches to a multiple.
std::vector<std::string> unlike_training(const Scene&, const TrainedWith&);

// The same for the network that moves a scene, and what else makes its frames wrong: gravity [m/s2] that it does not
// see, numbers of its own that are not finite. `name`: of its file, for people.
std::vector<std::string> network_warnings(const Scene&, const Vec3& gravity, const WeightFile&,
                                          const std::string& name);

}  // namespace selvedge

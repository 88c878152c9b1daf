#pragma once

#include <string>
#include <vector>

#include "learned/network/weights_hdf5.hpp"
#include "physics/scene/scene.hpp"
#include "pipeline/weights/trained_with_yaml.hpp"

namespace selvedge {

// A sentence for every quantity of every cloth that is far from training: a material's number by a factor of more than
// three, the mean edge length by more than one and a half. Networks do not extrapolate: too stiff a cloth slides off
// the body, and one with edges of half the length stretches to a multiple.
std::vector<std::string> unlike_training(const Scene&, const TrainedWith&);

// The same for the network that moves a scene, with other causes of wrong frames: gravity [m/s2] that the network does
// not take as input, and weights that are not finite. `name`: of its file, for people.
std::vector<std::string> network_warnings(const Scene&, const Vec3& gravity, const WeightFile&,
                                          const std::string& name);

}  // namespace selvedge

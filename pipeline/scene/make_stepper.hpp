#pragma once

#include <memory>

#include "learned/network/weights_hdf5.hpp"
#include "learned/repulsion/neighbour_scale.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// The file that the scene names by run.learned.weights. Throws Error where it names none; `cure`: what makes one.
std::filesystem::path weights_of(const Setup&, const std::string& cure);

// The stepper whose coefficients `selvedge teach` fits. It runs no network, and reads its file by run.learned.weights.
inline constexpr const char* carried_fitted_name = "carried_fitted";

// Whether the setup's kind of stepper reads run.learned.weights.
bool reads_weights(const Setup&);

// The network of a setup whose kind of stepper runs one, read once. Throws Error where the scene names none, and
// whatever read_weight_file does.
const WeightFile& network_of(const Setup&);

// Networks that scale the repulsive layer's pushes; null where the scene names none. Throws what read_neighbour_scale
// does.
std::shared_ptr<const NeighbourScale> read_refu_weights(const Setup&);

// Throws Error where a stepper with these traits does not take the setup's scene.
void check_accepted(const Setup&, const StepperTraits&);

// The setup's kind of stepper with what stands round it. Keeps a reference to the setup's scene. Throws Error for a
// scene that does not have what the stepper's traits ask for.
std::unique_ptr<Stepper> make_stepper(const Setup&);

// The setup's warnings and those of its network (network_warnings.hpp). Throws what network_of does.
std::vector<std::string> scene_warnings(const Setup&);

// The same, and a sentence for each force of the scene that the stepper ignores.
std::vector<std::string> run_warnings(const Setup&, const StepperTraits&);

}  // namespace selvedge

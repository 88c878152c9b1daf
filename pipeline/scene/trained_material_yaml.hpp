#pragma once

#include <optional>
#include <string>
#include <vector>

#include "learned/losses/loss_garment.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// The one material that a network was trained with, from the training text of its weight file. None where the text is
// empty, as in imported files, and where materials were drawn from ranges.
std::optional<VertexMaterial> trained_material(const std::string& training);

// A sentence for every quantity of every cloth that is over three times as large as in training, or under a third.
// Networks do not extrapolate: too stiff a cloth slides off the body.
std::vector<std::string> unlike_training(const Scene&, const VertexMaterial& trained);

// The same for a scene whose stepper runs a network; empty for all others. Reads the weight file; throws its errors.
std::vector<std::string> material_warnings(const Setup&);

}  // namespace selvedge

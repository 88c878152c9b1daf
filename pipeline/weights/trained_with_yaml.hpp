#pragma once

#include <optional>
#include <string>

#include "learned/losses/loss_garment.hpp"

namespace selvedge {

// Options of the training by the text in the weight file. Imported files have none.
struct TrainedWith {
  std::optional<VertexMaterial> material;  // absent also if materials were drawn from ranges
  std::optional<double> edge;              // of garments by code [m]
};

// Reads the training text of a weight file. Any other text gives no options.
TrainedWith trained_with(const std::string& training);

}  // namespace selvedge

#pragma once

#include <optional>
#include <string>

#include "learned/losses/loss_garment.hpp"

namespace selvedge {

// What a network was trained with, from the training text of its weight file: of imported files nothing is known.
struct TrainedWith {
  std::optional<VertexMaterial> material;  // absent where materials were drawn from ranges, too
  std::optional<double> edge;              // of garments by code [m]
};

TrainedWith trained_with(const std::string& training);

}  // namespace selvedge

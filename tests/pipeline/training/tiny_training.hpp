#pragma once

#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/training/rolling_state.hpp"
#include "pipeline/training/training_step.hpp"

namespace selvedge::fake {

inline TrainingOptions tiny_training() { return read_training(config_folder() / "training" / "tiny.yaml"); }

// The roll-outs of the configuration `tiny`, made once, because garment and mannequin take long.
inline RollMaker& tiny_maker() {
  static RollMaker maker{tiny_training(),
                         trained_architecture(tiny_training()).features,
                         make_training_world(tiny_training().samples, 1),
                         {}};
  return maker;
}

inline FrameMaking tiny_making() {
  FrameMaking making;
  making.features = trained_architecture(tiny_training()).features;
  making.losses = tiny_training().objective;
  making.passes = 2;
  return making;
}

}  // namespace selvedge::fake

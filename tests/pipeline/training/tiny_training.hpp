#pragma once

#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/training/rolling_state.hpp"
#include "pipeline/training/training_step.hpp"

namespace selvedge::fake {

inline TrainingOptions tiny_training() { return read_training(config_folder() / "training" / "tiny.yaml"); }

// A pool of few states that learns for 40 steps.
inline TrainingOptions few_steps(int states) {
  TrainingOptions options = tiny_training();
  options.steps = 40;
  options.pool.states = states;
  options.optimiser.warm_up = 4;
  return options;
}

inline std::vector<float> weights_of(Trainer& trainer) {
  std::vector<float> all;
  for (const WeightArray& array : weight_arrays(trainer.architecture, trainer.network.weights))
    all.insert(all.end(), array.data, array.data + array.rows * array.columns);
  return all;
}

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

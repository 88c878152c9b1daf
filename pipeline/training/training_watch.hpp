#pragma once

#include <array>

#include "collision/search/intersections.hpp"
#include "pipeline/training/trainer.hpp"

namespace selvedge {

// A fixed state, and the optimum of its frame.
struct FixedState {
  RollingState state;
  double inertial = 0, optimum = 0;  // loss of the motion without forces, and least loss [J]
  Points best;
  bool skinned = true;  // the skinned garment; false: a state after minimised frames
};

// The states and the roll-out on which a run is measured. All of them are of the training split.
struct TrainingWatch {
  std::vector<FixedState> states;
  Roll roll;
};

// Prepares them; takes seconds. The same for every run with these options.
TrainingWatch make_training_watch(const TrainingOptions&, Trainer&);

// What is seen of one kind of fixed states.
struct GapMeasure {
  double closed = 0;      // mean of (E(x + v) - E) / (E(x + v) - E*)
  double excess = 0;      // mean of E - E* [J]
  double log_excess = 0;  // mean of its decimal logarithm
  double rms = 0;         // mean distance to the optimum [m]
};

// What is seen of a roll-out, means over its frames but for what says otherwise.
struct RollMeasure {
  bool finite = true;
  int frames = 0;
  double energy = 0;                                  // sum of losses at full weights [J]
  double strain = 0, strain_99 = 0, strain_most = 0;  // principal, |s - 1|: mean, 99th percentile; most of all frames
  double deep = 0;                                    // part of the vertices deeper than 1 mm in the body
  double deepest = 0;                                 // of all frames [m]
  double kinetic = 0;                                 // [J]
  double jitter = 0;                                  // RMS of the change of acceleration [m/frame^2]
  double pairs = 0;                                   // of triangles of cloth that intersect
  double volume = 0;                                  // that cloth encloses with itself [m^3]
  int pairs_at_end = 0;
};

struct TrainingMeasure {
  long step = 0;
  GapMeasure skinned, minimised;
  RollMeasure roll;
};

// Measures the weights as they are: both kinds of fixed states and the roll-out. Changes nothing of the training.
TrainingMeasure measure(Trainer&, TrainingWatch&);

// One run of the network on the state's pass; false: refused. Does not change the network.
bool predict(Trainer&, const FrameMaking&, RollingState&, NextCloth&);

// Rolls out with the trainer's weights and looks at each frame. `gate`: as in PoolOptions.
RollMeasure measure_roll(Trainer&, const Roll&, int gate);

}  // namespace selvedge

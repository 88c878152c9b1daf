#pragma once

#include "pipeline/training/trainer.hpp"

namespace selvedge {

// A fixed state, and the optimum of its frame.
struct FixedState {
  RollingState state;
  double inertial = 0, optimum = 0;  // losses [J] of the motion without forces, and of the optimum
  Points best;
  bool skinned = true;  // the skinned garment; false: a state after minimised frames
};

// A roll-out from a simulated start, and where the solver's own roll-out ends.
struct TaughtRoll {
  Roll roll;
  Points end;  // [m]
};

// The states and roll-outs for measurements. All are of the training split.
struct TrainingWatch {
  std::vector<FixedState> states;
  Roll roll;
  std::vector<TaughtRoll> taught;  // none without a teacher
};

// Prepares the measurements in some seconds. The options determine the result.
TrainingWatch make_training_watch(const TrainingOptions&, Trainer&);

// Means over the fixed states of one kind, where E* is the least loss.
struct GapMeasure {
  double closed = 0;      // mean of (E(x + v) - E) / (E(x + v) - E*)
  double excess = 0;      // mean of E - E* [J]
  double log_excess = 0;  // mean decimal logarithm of E - E*
  double rms = 0;         // distance to the optimum [m]
};

// Measurements of a roll-out: means over its frames unless stated.
struct RollMeasure {
  bool finite = true;
  int frames = 0;
  double energy = 0;                                  // sum of losses at full weights [J]
  double strain = 0, strain_99 = 0, strain_most = 0;  // principal, |s - 1|: mean, 99th percentile, most of all frames
  double deep = 0;                                    // fraction of the vertices deeper than 1 mm in the body
  double deepest = 0;                                 // maximum over all frames [m]
  double kinetic = 0;                                 // [J]
  double jitter = 0;                                  // RMS of the change of acceleration [m/frame^2]
  double pairs = 0;                                   // intersecting pairs of cloth triangles
  double volume = 0;                                  // volume that cloth encloses with itself [m^3]
  int pairs_at_end = 0;
};

struct TrainingMeasure {
  long step = 0;
  GapMeasure skinned, minimised;
  RollMeasure roll;
  double taught =
      0;  // mean distance from the solver at the ends of taught roll-outs, over the masses [mm]; inf: not made
};

// Measures the current weights on both kinds of fixed states and the roll-out. The training does not change.
TrainingMeasure measure(Trainer&, TrainingWatch&);

// Runs the network once for the state's pass. Returns false if the graph is refused.
bool predict(Trainer&, const FrameMaking&, RollingState&, NextCloth&);

// Rolls out with the trainer's weights alone and measures each frame.
RollMeasure measure_roll(Trainer&, const Roll&);

// The distance from the solver after a roll-out with what runs behind the network, which is the response to contact at
// least [mm]; inf where a frame cannot be made.
double taught_distance(Trainer&, const TaughtRoll&);

}  // namespace selvedge

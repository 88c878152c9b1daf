#pragma once

#include <vector>

#include "learned/graph/integration.hpp"
#include "learned/graph/make_graph.hpp"
#include "learned/losses/objective.hpp"
#include "learned/steppers/safeguard.hpp"
#include "pipeline/training/training_roll.hpp"

namespace selvedge {

// A roll-out in progress: which frame is to be made, in which pass, and what was made.
struct RollingState {
  Roll roll;
  int frame = 0, pass = 0;
  GraphState now;                    // what the frame starts from; its guess and pass are those of the pass to come
  bool over = true;                  // the roll-out has ended
  std::unique_ptr<Safeguard> guard;  // of roll-outs that are advanced through it
  std::vector<char> body_left_out;   // faces of the body that meet others now or next; empty: none
  // Memory that is used again:
  GraphSearch search;
  LossSearch losses;
  GraphReport found;
};

// Begins a roll-out: at rest, out of the body, before a frame of 1/3 s; or as the clip moves.
void begin_roll(Roll, RollingState&);

// Goes on with a roll-out that was begun before, from what was kept of it.
struct KeptRolling {
  int frame = 0, pass = 0;
  Points x, previous, velocity, guess;
};
KeptRolling kept(const RollingState&);
void resume_roll(Roll, const KeptRolling&, RollingState&);

// Whether the frame to be made is the one in which cloth falls to rest.
bool is_settling(const RollingState&);

// What losses see of the frame and of a prediction. Refers to the state.
LossInputs inputs_of(const RollingState&, const SeenPositions&, const Points& predicted, double progress);

// How a network's frame is made.
struct FrameMaking {
  FeatureOptions features;
  LossOptions losses;
  int passes = 1;
  double progress = 1;  // of the run
};

// The graph of the pass to come, raw. False: refused, for something is not finite.
bool raw_graph_of(const FrameMaking&, const FeatureTables&, RollingState&, Graph&);

// The pass gave `next`: goes on to the next pass, or with the frame's last one to the next frame. A roll-out is over
// after its last frame, and where a free vertex is farther than `reset_distance` from the garment as worn, or is not
// finite.
void take_pass(const FrameMaking&, const NextCloth& next, double reset_distance, RollingState&);

// Lets the state's guard change the frame's last pass, where there is a guard. False: it gives the motion up.
bool pass_guard(const FrameMaking&, RollingState&, NextCloth& next);

// Steps of the gate: among base + t (next - base), with `count` values of t up to 1.2, the one with the least sum of
// losses; base is where the cloth is without forces.
NextCloth gated(const FrameMaking&, int count, const NextCloth& next, RollingState&);

}  // namespace selvedge

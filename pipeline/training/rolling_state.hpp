#pragma once

#include <future>
#include <vector>

#include "learned/graph/integration.hpp"
#include "learned/graph/make_graph.hpp"
#include "learned/losses/objective.hpp"
#include "learned/steppers/safeguard.hpp"
#include "pipeline/measures/minimise.hpp"
#include "pipeline/training/teacher_step.hpp"
#include "pipeline/training/training_roll.hpp"

namespace selvedge {

// A roll-out in progress: the next frame and pass, and the results so far.
struct RollingState {
  Roll roll;
  int frame = 0, pass = 0;
  GraphState now;                          // the start of the frame, with guess and number of the next pass
  bool over = true;                        // the roll-out has ended
  std::unique_ptr<Safeguard> guard;        // filters the motion of the roll-out; null: none
  std::unique_ptr<Stepper> behind;         // runs behind the network; null: nothing does
  std::shared_ptr<RollSolver> solver;      // of a teacher; null: none was asked yet in this roll-out
  std::shared_future<TeacherStep> taught;  // a teacher's frame from here; invalid: none was asked for
  std::vector<char> body_left_out;         // faces of the body that meet others now or next; empty: none
  // Memory that is used again:
  GraphSearch search;
  LossSearch losses;
  GraphReport found;
  AssemblyScratch elastic;
};

// Begins a roll-out: at rest and outside the body before a frame of 1/3 s, or with the motion of the clip.
void begin_roll(Roll, RollingState&);

// The part of a roll-out that a checkpoint keeps, and the start from it.
struct KeptRolling {
  int frame = 0, pass = 0;
  Points x, previous, velocity, guess;
};
KeptRolling kept(const RollingState&);
void resume_roll(Roll, const KeptRolling&, RollingState&);

// Whether the cloth falls to rest in the next frame.
bool is_settling(const RollingState&);

// The losses' inputs for the frame and a prediction. They refer to the state. Waits for the teacher's frame, if one was
// asked for.
LossInputs inputs_of(const RollingState&, const SeenPositions&, const Points& predicted, double progress);

// The options of a network's frames.
struct FrameMaking {
  FeatureOptions features;
  LossOptions losses;
  int passes = 1;
  double progress = 1;  // of the run
};

// Makes the raw graph of the next pass. Returns false if something is not finite.
bool raw_graph_of(const FrameMaking&, const FeatureTables&, RollingState&, Graph&);

// Takes the result of a pass, and proceeds to the next pass or frame. The roll-out ends after its last frame, or if a
// free vertex is not finite or farther than `reset_distance` from the skinned garment.
void take_pass(const FrameMaking&, const NextCloth& next, double reset_distance, RollingState&);

// Lets the guard of the state, if there is one, correct the last pass of the frame. Returns false if it gives up.
bool pass_guard(const FrameMaking&, RollingState&, NextCloth& next);

// The gate. Of the candidates base + t (next - base), with `count` values of t up to 1.2, it returns the one with the
// least loss. base is the motion without forces.
NextCloth gated(const FrameMaking&, int count, const NextCloth& next, RollingState&);

// The prediction with the least sum of losses [J] that L-BFGS, preconditioned by the Jacobi diagonal, finds from
// `start`. Pinned vertices stay. No network can be better in this frame.
Minimised minimised(const FrameMaking&, RollingState&, const Points& start, int most_evaluations);

}  // namespace selvedge

#pragma once

#include <span>
#include <vector>

#include "collision/contour/segments.hpp"
#include "learned/graph/cloth_pairs.hpp"
#include "learned/losses/loss_garment.hpp"
#include "learned/losses/loss_options.hpp"

namespace selvedge {

class FramePotential;  // physics/steppers/frame_potential.hpp

// The inputs of the losses for one frame. The caller owns the arrays. Without a body, the pointers to it are all null.
struct LossInputs {
  const LossGarment* garment = nullptr;
  const Points* x = nullptr;          // positions now, for HOOD after pinned vertices moved [m]
  const Points* velocity = nullptr;   // displacement of free motion, for the inertia [m/frame]
  const Points* predicted = nullptr;  // positions of the next frame [m]
  const Surface* body = nullptr;
  const Points *body_previous = nullptr, *body_now = nullptr, *body_next = nullptr;
  const std::vector<char>* body_left_out = nullptr;  // one flag per face that cloth ignores; null: none
  const Points* acceleration = nullptr;              // of all forces but contact, V x 3 [m/s2]; null: of gravity alone
  std::span<const ClothPair> repulsion;              // vertex-face pairs of the cloth that repel
  const Points* target = nullptr;       // positions of the next frame that the solver makes [m]; null: none
  FramePotential* potential = nullptr;  // the solver's potential of the next frame; null: none
  bool contours = true;  // false: the contour loss counts nothing (published: in a first frame, and if none attracts)
  bool is_initial = false;     // the cloth falls to rest: inertia takes relaxation_dt
  double timestep = 1.0 / 30;  // [s]
  double progress = 1;         // of the run, in [0, 1]
};

bool has_body(const LossInputs&);  // the body has a face at least

// Contacts and crossings that the losses need. Only friction_after and crossings depend on the prediction.
struct LossMatches {
  std::vector<int> collision_face;  // one per sample of the cloth (CollisionLoss::samples), -1: none
  std::vector<int> friction_before, friction_after;
  Segments crossings;  // of the predicted cloth with itself
};

// The inputs of a term's value.
struct LossFrame {
  const LossInputs& in;
  const LossOptions& options;
  const LossMatches& matches;
  const LossGarment& garment = *in.garment;
  const Points& x = *in.predicted;
};

// One term of the objective.
struct LossRow {
  const char* name;    // name of the term and of its columns in steps.csv
  const char* weighs;  // key of the weight below `objective`
  const char* about;   // what is summed up
  const LossRamp& (*weight)(const LossOptions&);
  bool (*takes_part)(const LossInputs&);                // null: always
  double (*value)(const LossFrame&, Points* gradient);  // unweighted; adds the derivative, which may be null
};

// All terms, in the order in which they are summed up. The sum, the columns of steps.csv, the page of a training and
// docs/training.md are made from this list. How to add one: docs/extending.md.
std::span<const LossRow> loss_rows();

}  // namespace selvedge

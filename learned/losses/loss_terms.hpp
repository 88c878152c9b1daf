#pragma once

#include <span>
#include <vector>

#include "collision/contour/segments.hpp"
#include "learned/graph/cloth_pairs.hpp"
#include "learned/losses/loss_garment.hpp"
#include "learned/losses/loss_options.hpp"

namespace selvedge {

// The inputs of the losses for one frame. The caller owns the arrays. Without a body, the pointers to it are all null.
struct LossInputs {
  const LossGarment* garment = nullptr;
  const Points* x = nullptr;          // now, as the losses of the model see it: HOOD after pinned vertices moved [m]
  const Points* velocity = nullptr;   // of free motion, for the inertia [m/frame]
  const Points* predicted = nullptr;  // the next frame [m]
  const Surface* body = nullptr;
  const Points *body_previous = nullptr, *body_now = nullptr, *body_next = nullptr;
  const std::vector<char>* body_left_out = nullptr;  // by face: cloth ignores it; null: none
  const Points* acceleration = nullptr;  // by all forces without contact, V x 3 [m/s2]; null: by gravity alone
  std::span<const ClothPair> repulsion;  // vertices and faces of the cloth that repel
  bool contours = true;  // false: the contour loss counts nothing (published: in a first frame, and if none attracts)
  bool is_initial = false;     // the cloth falls to rest: inertia takes relaxation_dt
  double timestep = 1.0 / 30;  // [s]
  double progress = 1;         // of the run, in [0, 1]
};

bool has_body(const LossInputs&);  // with a face at least

// Contacts and crossings that the losses need. They depend on the state; only the last two depend on the prediction.
struct LossMatches {
  std::vector<int> collision_face;  // of each sample of the cloth (CollisionLoss::samples), -1: none
  std::vector<int> friction_before, friction_after;
  Segments crossings;  // of the predicted cloth with itself
};

// What the value of a term is computed from.
struct LossFrame {
  const LossInputs& in;
  const LossOptions& options;
  const LossMatches& matches;
  const LossGarment& garment = *in.garment;
  const Points& x = *in.predicted;
};

// One term of the objective.
struct LossRow {
  const char* name;    // of the term, and of its columns in steps.csv
  const char* weighs;  // key of its weight below `objective`
  const char* about;   // what is summed up
  const LossRamp& (*weight)(const LossOptions&);
  bool (*takes_part)(const LossInputs&);                // null: always
  double (*value)(const LossFrame&, Points* gradient);  // without the weight; adds the derivative, which may be null
};

// All terms, in the order in which they are summed up: the one list of them. The sum, the columns of steps.csv, the
// page of a training and docs/training.md are made from it. How to add one: docs/extending.md.
std::span<const LossRow> loss_rows();

}  // namespace selvedge

#pragma once

#include <span>
#include <string>
#include <vector>

#include "collision/contour/segments.hpp"
#include "learned/graph/cloth_pairs.hpp"
#include "learned/graph/graph_state.hpp"
#include "learned/graph/nearest_faces.hpp"
#include "learned/graph/seen_positions.hpp"
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

// The inputs that a state of a graph gives. All arguments are referred to.
LossInputs loss_inputs(const LossGarment&, const GraphScene&, const GraphState&, const SeenPositions&,
                       const Points& predicted);

// Contacts and crossings that the losses need. They depend on the state; only the last two depend on the prediction.
struct LossMatches {
  std::vector<int> collision_face;  // of each sample of the cloth (CollisionLoss::samples), -1: none
  std::vector<int> friction_before, friction_after;
  Segments crossings;  // of the predicted cloth with itself
};

// Kept between calls. It saves time and changes nothing.
struct LossSearch {
  NearestFaces collision, before, after;
  ClothSearch cloth;
  LossMatches matches;
};

struct LossTerm {
  std::string name;          // stretching, springs with it; bending, gravity or forces, inertia, collision, friction,
                             // repulsion, volume, vertex_repulsion, contours
  double weight = 0;         // now, inside value and gradient
  double value = 0;          // [J]
  double gradient_norm = 0;  // over vertices that are not pinned [N]
};

// Adds to `gradient` (V x 3, may be null) the derivative of the weighted sum with respect to the predicted positions,
// and returns the terms with a weight, in the order of LossTerm::name. A term whose value or gradient is not finite is
// returned as it is and adds nothing. Throws Error where sizes do not fit.
std::vector<LossTerm> add_losses(const LossInputs&, const LossOptions&, LossSearch&, Points* gradient);

// The two parts of add_losses: the search for matches, and the sum for given matches (such as the authors' own).
void find_matches(const LossInputs&, const LossOptions&, LossSearch&);
std::vector<LossTerm> add_losses(const LossInputs&, const LossOptions&, const LossMatches&, Points* gradient);

double sum_of(std::span<const LossTerm>);  // [J]

// The sum at predicted = base + t (inputs.predicted - base) for each t: the gate of the fast recipe takes the least.
// Body faces are matched once, for they depend on where the cloth is now.
std::vector<double> losses_along(const LossInputs&, const LossOptions&, const Points& base, std::span<const double> t,
                                 LossSearch&);

// From and to single precision, V x 3 by rows.
Points points_of(std::span<const float>);
void add_to(const Points&, std::span<float>);

}  // namespace selvedge

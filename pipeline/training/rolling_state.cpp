#include "pipeline/training/rolling_state.hpp"

#include <cmath>

#include "learned/graph/elastic_motion.hpp"
#include "learned/losses/force_input.hpp"
#include "learned/steppers/learned_state.hpp"
#include "physics/steppers/carried_guess.hpp"

namespace selvedge {
namespace {

Points wide(const PointsF& x) { return x.cast<double>(); }

// Sets the carried guess as a run would have it. Without a body nothing wears the cloth. Of a settling frame, in which
// the body stands still, the guess is where the cloth is.
void set_carried_guess(RollingState& state) {
  const Roll& roll = state.roll;
  const bool settling = is_settling(state), after_settling = roll.request.still && state.frame == 1;
  const int now = settling ? 1 : state.frame + (roll.request.still ? 0 : 1);
  const auto drive_at = [&](int entry) {
    const Points targets = wide(roll.cloth[static_cast<std::size_t>(entry)]);
    Drive drive;
    drive.pins = targets(roll.scene->scene.pins, Eigen::all);
    drive.acceleration = roll.forces.acceleration;
    if (roll.request.with_body) drive.skinned_targets = targets;
    return drive;
  };
  State before, from;
  before.x = state.now.previous;
  before.memory = carried_memory({}, drive_at(settling || after_settling ? now : now - 1), before.x);
  from.x = state.now.x;
  from.v = state.now.velocity / learned_dt;
  from.memory = carried_memory(before, drive_at(now), from.x);
  set_carried_base(roll.scene->scene, from, drive_at(settling ? now : now + 1), learned_dt, state.now);
}

// Sets the body, and the skinned target of the garment at the end of the frame.
void set_surroundings(RollingState& state) {
  const Roll& roll = state.roll;
  const bool settling = is_settling(state);
  const int entry = state.frame + (roll.request.still ? 0 : 1);  // of the body now; a settling frame uses the next one
  const auto body_at = [&](int k) { return wide(roll.body[static_cast<std::size_t>(k)]); };
  const bool after_settling = roll.request.still && state.frame == 1;
  state.now.body = body_at(settling ? 1 : entry);
  state.now.body_previous = settling || after_settling ? state.now.body : body_at(entry - 1);
  state.now.body_target = settling ? state.now.body : body_at(entry + 1);
  state.now.target = wide(roll.cloth[static_cast<std::size_t>(entry + 1)]);
  state.body_left_out.clear();
  if (!roll.body_left_out.empty()) {
    state.body_left_out = roll.body_left_out[static_cast<std::size_t>(settling ? 1 : entry)];
    const std::vector<char>& next = roll.body_left_out[static_cast<std::size_t>(settling ? 1 : entry + 1)];
    for (std::size_t f = 0; f < next.size(); ++f) state.body_left_out[f] = state.body_left_out[f] || next[f];
  }
  state.now.timestep = settling ? settling_time : learned_dt;
  state.now.is_init = settling;
  state.now.no_cloth_edges = settling || !roll.request.cloth_contact;
  state.now.no_space_edges = settling || !roll.space_edges;
  if (roll.shows_forces)
    state.now.acceleration =
        free_acceleration(roll.scene->scene, state.now.x, state.now.velocity / learned_dt, roll.forces);
  else
    state.now.acceleration.resize(0, 3);
  state.now.guess.resize(0, 3);
  state.now.frames.clear();
  if (roll.carried) set_carried_guess(state);
  state.now.force.resize(0, 3);
  state.now.pass = state.pass = 0;
  state.taught = {};
}

bool is_lost(const RollingState& state, double reset_distance) {
  if (!state.now.x.allFinite() || !state.now.velocity.allFinite()) return true;
  const int entry = state.frame + (state.roll.request.still ? 0 : 1);
  const Points target = wide(state.roll.cloth[static_cast<std::size_t>(entry)]);
  return (state.now.x - target).rowwise().norm().maxCoeff() > reset_distance;
}

}  // namespace

bool is_settling(const RollingState& state) { return state.roll.request.still && state.frame == 0; }

void begin_roll(Roll roll, RollingState& state) {
  state.behind = nullptr;  // it refers to the roll-out before
  state.roll = std::move(roll);
  state.frame = 0;
  state.over = false;
  state.search = {};
  state.losses = {};
  state.solver = nullptr;
  const Roll& own = state.roll;
  state.now.x = own.start;
  if (own.request.still) {
    if (own.request.with_body) push_out(own.scene->graph.body, wide(own.body[1]), push_out_margin, state.now.x);
    state.now.previous = state.now.x;
    state.now.velocity = Points::Zero(state.now.x.rows(), 3);
  } else {
    state.now.velocity = own.velocity.rows() > 0 ? own.velocity : Points(wide(own.cloth[1]) - wide(own.cloth[0]));
    state.now.previous = state.now.x - state.now.velocity;
  }
  set_surroundings(state);
}

KeptRolling kept(const RollingState& state) {
  return {state.frame, state.pass, state.now.x, state.now.previous, state.now.velocity, state.now.guess};
}

void resume_roll(Roll roll, const KeptRolling& from, RollingState& state) {
  begin_roll(std::move(roll), state);
  state.frame = from.frame;
  state.now.x = from.x;
  state.now.previous = from.previous;
  state.now.velocity = from.velocity;
  set_surroundings(state);
  state.now.guess = from.guess;
  state.now.pass = state.pass = from.pass;
}

LossInputs inputs_of(const RollingState& state, const SeenPositions& seen, const Points& predicted, double progress) {
  LossInputs inputs = loss_inputs(state.roll.scene->losses, state.roll.scene->graph, state.now, seen, predicted);
  inputs.repulsion = state.found.cloth_pairs.repulsion;
  inputs.contours = !is_settling(state) && state.roll.request.cloth_contact;
  inputs.is_initial = is_settling(state);
  if (!state.body_left_out.empty()) inputs.body_left_out = &state.body_left_out;
  if (state.now.acceleration.rows() > 0) inputs.acceleration = &state.now.acceleration;
  if (state.taught.valid()) {
    const TeacherStep& taught = state.taught.get();
    if (taught.x.rows() > 0) inputs.target = &taught.x;
    inputs.potential = taught.potential;
  }
  inputs.progress = progress;
  return inputs;
}

bool raw_graph_of(const FrameMaking& making, const FeatureTables& tables, RollingState& state, Graph& graph) {
  const TrainingScene& scene = *state.roll.scene;
  if (making.features.force_inputs) {
    const SeenPositions seen = seen_positions(scene.rest, state.now, making.features);
    const Points guess = guess_of(scene.rest, state.now, seen, making.features);
    state.now.force = shown_force(inputs_of(state, seen, guess, making.progress), state.pass,
                                  making.features.contour_force, state.losses);
  }
  if (making.features.guess_inputs) {
    const SeenPositions seen = seen_positions(scene.rest, state.now, making.features);
    state.now.elastic = elastic_motion(scene.elastic, scene.graph, state.now.timestep,
                                       guess_of(scene.rest, state.now, seen, making.features), state.elastic);
  }
  make_raw_graph(scene.graph, scene.rest, state.now, making.features, tables, state.search, graph, state.found);
  return state.found.refused.empty();
}

void take_pass(const FrameMaking& making, const NextCloth& next, double reset_distance, RollingState& state) {
  if (state.pass + 1 < making.passes) {
    state.now.guess = next.x;
    state.now.pass = ++state.pass;
    return;
  }
  const bool settled = is_settling(state);
  state.now.previous = seen_positions(state.roll.scene->rest, state.now, making.features).x;
  state.now.x = next.x;
  state.now.velocity = next.velocity;
  if (settled) {
    state.now.previous = state.now.x;
    if (making.passes > 1) state.now.velocity.setZero();  // HOOD continues with the settling frame's velocity
  }
  ++state.frame;
  state.over = state.frame >= state.roll.request.frames || is_lost(state, reset_distance);
  if (!state.over) set_surroundings(state);
}

bool pass_guard(const FrameMaking& making, RollingState& state, NextCloth& next) {
  if (!state.guard) return true;
  const Points from = seen_positions(state.roll.scene->rest, state.now, making.features).x, proposed = next.x;
  const bool kept_on = (*state.guard)(from, next.x).kept;
  next.velocity += next.x - proposed;
  return kept_on;
}

NextCloth gated(const FrameMaking& making, int count, const NextCloth& next, RollingState& state) {
  const TrainingScene& scene = *state.roll.scene;
  const SeenPositions seen = seen_positions(scene.rest, state.now, making.features);
  const Points base = inertial_guess(scene.rest, state.now, seen, making.features);
  std::vector<double> factors;
  for (int k = 0; k < count; ++k) factors.push_back(count > 1 ? 1.2 * k / (count - 1) : 1);
  const std::vector<double> sums =
      losses_along(inputs_of(state, seen, next.x, making.progress), making.losses, base, factors, state.losses);
  std::size_t best = sums.size() - 1;
  for (std::size_t k = 0; k < sums.size(); ++k)
    if (std::isfinite(sums[k]) && !(sums[k] >= sums[best])) best = k;
  NextCloth result{base + factors[best] * (next.x - base), {}};
  result.velocity = result.x - seen.x;
  for (const int pin : scene.rest.pinned) result.velocity.row(pin) = next.velocity.row(pin);
  return result;
}

Minimised minimised(const FrameMaking& making, RollingState& state, const Points& start, int most_evaluations) {
  const TrainingScene& scene = *state.roll.scene;
  const SeenPositions seen = seen_positions(scene.rest, state.now, making.features);
  const auto evaluate = [&](const Points& x, Points& gradient) {
    gradient.setZero(x.rows(), 3);
    const double sum =
        sum_of(add_losses(inputs_of(state, seen, x, making.progress), making.losses, state.losses, &gradient));
    for (const int pin : scene.rest.pinned) gradient.row(pin).setZero();
    return sum;
  };
  const double dt = is_settling(state) ? making.losses.relaxation_dt : state.now.timestep;
  return minimised(evaluate, jacobi_diagonal(scene.losses, dt), start, most_evaluations);
}

}  // namespace selvedge

#include "pipeline/training/training_watch.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/error.hpp"
#include "collision/search/intersections.hpp"
#include "learned/graph/integration.hpp"
#include "learned/graph/nearest_faces.hpp"
#include "learned/losses/cloth_losses.hpp"
#include "learned/losses/volume_loss.hpp"
#include "pipeline/measures/motion_measures.hpp"
#include "pipeline/training/simulate_frames.hpp"

namespace selvedge {
namespace {

constexpr int most_evaluations = 500;
constexpr int frames_before = 5;  // minimised frames before a fixed state

// The options of frames with all losses at full weight.
FrameMaking full_making(const Trainer& trainer) {
  FrameMaking making = frame_making(trainer);
  making.progress = 1;
  return making;
}

Points inertial_of(const FrameMaking& making, const RollingState& state) {
  const RestGraph& rest = state.roll.scene->rest;
  return inertial_guess(rest, state.now, seen_positions(rest, state.now, making.features), making.features);
}

double sum_at(const FrameMaking& making, RollingState& state, const Points& x) {
  const SeenPositions seen = seen_positions(state.roll.scene->rest, state.now, making.features);
  return sum_of(add_losses(inputs_of(state, seen, x, making.progress), making.losses, state.losses, nullptr));
}

RollRequest watched_request(const TrainingOptions& options, const TrainingWorld& world, const RollRequest& who,
                            int clip, int first, int frames, bool still) {
  RollRequest request;
  request.wear = who.wear;
  request.body = who.body;
  request.clip = clip;
  request.still = still;
  const int there = frame_count(world, request.body, clip);
  request.frames = std::max(1, std::min(frames, there - 1));
  request.first_frame = std::clamp(first, 0, std::max(0, there - 1 - request.frames));
  request.cloth_contact = options.contact.edges;
  return request;
}

// The garment and the clip of the options, if they exist, on a body that has them.
RollRequest watched(const WatchOptions& options, const TrainingWorld& world) {
  RollRequest request;
  const auto wear = std::ranges::find(world.wear, options.garment, &TrainingWear::name);
  if (wear != world.wear.end()) request.wear = static_cast<int>(wear - world.wear.begin());
  const TrainingPerson& person = wearer(world, request.wear);
  request.body = person.bodies.front();
  for (const int body : person.bodies) {
    const std::vector<TrainingClip>& clips = world.bodies[static_cast<std::size_t>(body)].clips;
    const auto found = std::ranges::find(clips, options.clip, &TrainingClip::name);
    if (found == clips.end()) continue;
    request.body = body;
    request.clip = static_cast<int>(found - clips.begin());
    break;
  }
  return request;
}

// Every frame of a network of several passes counts as one.
FixedState fixed_state(Trainer& trainer, const FrameMaking& making, Roll roll, bool skinned) {
  FixedState fixed;
  fixed.skinned = skinned;
  begin_roll(std::move(roll), fixed.state);
  teach(trainer, fixed.state);
  FrameMaking whole = making;
  whole.passes = 1;
  for (int k = 0; !skinned && k < frames_before && !fixed.state.over; ++k) {
    const Points x = inertial_of(whole, fixed.state);
    const Minimised made = minimised(whole, fixed.state, x, most_evaluations);
    const SeenPositions seen = seen_positions(fixed.state.roll.scene->rest, fixed.state.now, making.features);
    NextCloth next{made.x, made.x - seen.x};
    if (is_settling(fixed.state)) next.velocity.setZero();
    take_pass(whole, next, HUGE_VAL, fixed.state);
    teach(trainer, fixed.state);
  }
  const Points inertial = inertial_of(whole, fixed.state);
  fixed.inertial = sum_at(whole, fixed.state, inertial);
  Minimised made = minimised(whole, fixed.state, inertial, most_evaluations);
  fixed.optimum = made.value;
  fixed.best = std::move(made.x);
  return fixed;
}

GapMeasure gap_of(Trainer& trainer, const FrameMaking& making, std::vector<FixedState>& states, bool skinned) {
  GapMeasure gap;
  int count = 0;
  for (FixedState& fixed : states) {
    if (fixed.skinned != skinned) continue;
    const KeptRolling before = kept(fixed.state);
    NextCloth next;
    bool made = true;
    for (int pass = 0; made && pass < making.passes; ++pass) {
      made = predict(trainer, making, fixed.state, next);
      fixed.state.now.guess = next.x;
      fixed.state.now.pass = fixed.state.pass = pass + 1;
    }
    fixed.state.now.guess = before.guess;
    fixed.state.now.pass = fixed.state.pass = before.pass;
    const double value = made ? sum_at(making, fixed.state, next.x) : HUGE_VAL;
    const double excess = std::max(value - fixed.optimum, 1e-12);
    gap.closed += (fixed.inertial - value) / (fixed.inertial - fixed.optimum);
    gap.excess += excess;
    gap.log_excess += std::log10(excess);
    if (made) gap.rms += std::sqrt((next.x - fixed.best).rowwise().squaredNorm().mean());
    ++count;
  }
  for (double* value : {&gap.closed, &gap.excess, &gap.log_excess, &gap.rms}) *value /= std::max(count, 1);
  return gap;
}

void add_depth(const Surface& body, const Points& body_x, const Points& x, NearestFaces& search, RollMeasure& roll) {
  if (body_x.rows() == 0) return;
  constexpr double deep = 1e-3;  // [m]
  const std::vector<int>& faces = nearest_centroids(body, body_x, {}, x, search);
  int count = 0;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const CentroidPlane plane = centroid_plane(body, body_x, faces[static_cast<std::size_t>(v)]);
    const double depth = -(row(x, static_cast<int>(v)) - plane.centroid).dot(plane.normal);
    if (depth > deep) ++count;
    roll.deepest = std::max(roll.deepest, depth);
  }
  roll.deep += static_cast<double>(count) / static_cast<double>(x.rows());
}

// The start of each is where the solver brings the skinned garment.
std::vector<Roll> rolls_to_teach(const TrainingOptions& options, RollMaker& maker, const RollRequest& who, int clips) {
  std::vector<Roll> rolls;
  for (int k = 0; k < options.watch.taught_rolls; ++k) {
    const int at = (who.clip + k) % clips;
    const int first = frame_count(maker.world, who.body, at) / 3 + 10 * (k / clips);
    RollRequest request = watched_request(options, maker.world, who, at, first, options.watch.taught_frames, false);
    request.simulated = options.samples.simulated_frames;
    rolls.push_back(make_roll(maker, request));
  }
  return rolls;
}

// Lets the solver go on from the start of the roll-out. Throws Error where it cannot.
TaughtRoll taught_roll(const TrainingOptions& options, Roll roll) {
  TaughtRoll taught{std::move(roll), {}};
  RollingState state;
  begin_roll(taught.roll, state);
  std::vector<SkinnedFrame> ends;
  for (std::size_t k = 2; k < taught.roll.body.size(); ++k) ends.push_back({taught.roll.body[k], taught.roll.cloth[k]});
  const Scene& scene = taught.roll.scene->scene;
  const auto solver = make_teacher_stepper(scene, options.teacher);
  State at = solver_frame(state).from;
  if (!taught.roll.usable || !simulate_frames(*solver, scene, taught.roll.forces, ends, at))
    throw Error("the solver cannot make the roll-out that networks are compared with", "training " + options.name,
                "give another `watch.clip` or `watch.garment`");
  taught.end = std::move(at.x);
  return taught;
}

}  // namespace

double taught_distance(Trainer& trainer, const TaughtRoll& taught) {
  const FrameMaking making = full_making(trainer);
  const BehindNetwork behind = trainer.options.pool.behind;
  RollingState state;
  begin_roll(taught.roll, state);
  state.behind =
      make_behind(taught.roll.scene->scene, behind == BehindNetwork::nothing ? BehindNetwork::response : behind);
  while (!state.over) {
    NextCloth next;
    if (!predict(trainer, making, state, next)) return HUGE_VAL;
    if (state.pass + 1 == making.passes && !pass_behind(state, next)) return HUGE_VAL;
    take_pass(making, next, HUGE_VAL, state);
  }
  return target_loss(taught.roll.scene->losses, taught.end, state.now.x, nullptr);
}

bool predict(Trainer& trainer, const FrameMaking& making, RollingState& state, NextCloth& next) {
  const FeatureTables& tables = trainer.network.weights.tables;
  if (!raw_graph_of(making, tables, state, trainer.graph)) return false;
  normalise(making.features, tables, trainer.graph);
  const FeatureRows output = run_forward(trainer.network, trainer.graph, trainer.tape);
  next = integrate(state.roll.scene->rest, state.now, making.features, tables.output, output);
  return next.x.allFinite();
}

RollMeasure measure_roll(Trainer& trainer, const Roll& roll) {
  const FrameMaking making = full_making(trainer);
  const Scene& scene = roll.scene->scene;
  RollingState state;
  begin_roll(roll, state);
  RollMeasure result;
  MotionTrace trace;
  NearestFaces nearest;
  IntersectionCache cache;
  double squares = 0;
  int jumps = 0;
  while (!state.over) {
    NextCloth next;
    if (!predict(trainer, making, state, next)) {
      result.finite = false;
      break;
    }
    const bool last_pass = state.pass + 1 == making.passes, settling = is_settling(state);
    if (last_pass && !settling) {
      teach(trainer, state);
      result.energy += sum_at(making, state, next.x);
      const StrainMeasure strain = strain_of(scene, next.x);
      result.strain += strain.mean;
      result.strain_99 += strain.p99;
      result.strain_most = std::max(result.strain_most, strain.most);
      add_depth(roll.scene->graph.body, state.now.body_target, next.x, nearest, result);
      for (Eigen::Index v = 0; v < next.x.rows(); ++v)
        result.kinetic += 0.5 * roll.scene->losses.mass[static_cast<std::size_t>(v)] *
                          next.velocity.row(v).squaredNorm() / (state.now.timestep * state.now.timestep);
      result.pairs_at_end = static_cast<int>(intersecting_pairs(scene.surface, next.x, cache).size());
      result.pairs += result.pairs_at_end;
      VolumeCounts counts;
      volume_loss(roll.scene->losses.closed, VolumeLoss{}, next.x, nullptr, &counts);
      result.volume += counts.volume;
      squares += trace.add(next.x);
      jumps += trace.x3.rows() > 0 && result.frames >= 3 ? 1 : 0;
      ++result.frames;
    }
    take_pass(making, next, HUGE_VAL, state);
  }
  for (double* sum : {&result.energy, &result.strain, &result.strain_99, &result.deep, &result.kinetic, &result.pairs,
                      &result.volume})
    *sum /= std::max(result.frames, 1);
  result.jitter = std::sqrt(squares / std::max(jumps, 1));
  result.finite = result.finite && std::isfinite(result.energy);
  return result;
}

TrainingWatch make_training_watch(const TrainingOptions& options, Trainer& trainer) {
  TrainingWatch watch;
  RollMaker& maker = *trainer.maker;
  const FrameMaking making = full_making(trainer);
  std::vector<Roll> rolls, to_teach;
  trainer.queue->locked([&] {
    const TrainingWorld& world = maker.world;
    const RollRequest who = watched(options.watch, world);
    const auto clips = static_cast<int>(world.bodies[static_cast<std::size_t>(who.body)].clips.size());
    const double noise = std::exchange(maker.options.samples.noise, 0);
    watch.roll = make_roll(maker, watched_request(options, world, who, who.clip, 0, options.watch.frames + 1, true));
    for (int k = 0; k < options.watch.fixed_states; ++k) {
      const bool skinned = k % 2 == 0;
      const int at = (who.clip + k / 2) % clips, frames = skinned ? 1 : frames_before + 1;
      const int first = frame_count(world, who.body, at) / 3 + 10 * (k / 2 / clips);
      rolls.push_back(make_roll(maker, watched_request(options, world, who, at, first, frames, !skinned)));
    }
    if (trainer.teacher) to_teach = rolls_to_teach(options, maker, who, clips);
    maker.options.samples.noise = noise;
  });
  for (Roll& roll : to_teach) watch.taught.push_back(taught_roll(options, std::move(roll)));
  for (std::size_t k = 0; k < rolls.size(); ++k)
    watch.states.push_back(fixed_state(trainer, making, std::move(rolls[k]), k % 2 == 0));
  return watch;
}

TrainingMeasure measure(Trainer& trainer, TrainingWatch& watch) {
  const FrameMaking making = full_making(trainer);
  TrainingMeasure result;
  result.step = trainer.counts.step;
  result.skinned = gap_of(trainer, making, watch.states, true);
  result.minimised = gap_of(trainer, making, watch.states, false);
  result.roll = measure_roll(trainer, watch.roll);
  for (const TaughtRoll& taught : watch.taught)
    result.taught += taught_distance(trainer, taught) / static_cast<double>(watch.taught.size());
  return result;
}

}  // namespace selvedge

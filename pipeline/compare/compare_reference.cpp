#include "pipeline/compare/compare_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "collision/geometry/error.hpp"
#include "learned/steppers/learned_state.hpp"
#include "physics/energies/measures.hpp"
#include "pipeline/compare/algebraic_error.hpp"
#include "pipeline/measures/published_measures.hpp"
#include "pipeline/run/jitter.hpp"
#include "pipeline/run/prepare.hpp"
#include "pipeline/run/simulate.hpp"
#include "pipeline/scene/make_stepper.hpp"

namespace selvedge {
namespace {

constexpr int fine = 16, half_as_fine = 8;  // steps a frame

// Root mean square over states of equal weight.
struct Mean {
  double sum = 0;
  int count = 0;
  void add(double value) {
    sum += value * value;
    ++count;
  }
  double value() const { return count > 0 ? std::sqrt(sum / count) : 0; }
};

struct Flight {
  State end;
  StepReport first, last;
  bool stopped = false;
  bool arrived() const { return last.status == StepStatus::accepted && !stopped; }
};

Flight fly(const Setup& setup, State from, int frames, const Stop& stop,
           const std::function<void(const State&)>& observe = {}, RowWatch* row = nullptr) {
  const std::unique_ptr<Stepper> stepper = make_stepper(setup);
  Flight flight;
  flight.end = std::move(from);
  flight.last = simulate(
      setup.scene, *stepper, setup.drive_at, 1 / setup.run.fps, flight.end.frame + frames, flight.end,
      [&](const FrameEvent& event) {
        if (flight.first.status == StepStatus::not_run) flight.first = event.report;
        if (observe && event.report.status == StepStatus::accepted) observe(event.state);
        flight.stopped = stop && stop();
        return !flight.stopped && (!row || row->goes_on(event.report, event.state.x));
      },
      row ? row->stop_flag() : StopFlag());
  return flight;
}

Setup with_steps(const Comparison& comparison, const CompareScene& scene, bool short_form, int steps) {
  std::vector<std::string> overrides = comparison.reference;
  overrides.push_back(fmt::format("run.substeps={}", steps));
  return read_compared(scene, short_form, overrides, comparison.kinds);
}

// What the scene's minimisers are held against where all take a step a frame.
Setup with_algebraic(const Comparison& comparison, const CompareScene& scene, bool short_form) {
  std::vector<std::string> overrides{"run.substeps=1", "solver.velocity_tolerance=1e-6", "solver.relative_tolerance=0",
                                     "solver.max_newton=60", "solver.linear_tolerance=0.01"};
  overrides.insert(overrides.end(), comparison.algebraic.begin(), comparison.algebraic.end());
  return read_compared(scene, short_form, overrides, comparison.kinds);
}

void check_arrived(const Flight& flight, const Setup& setup) {
  if (!flight.stopped && !flight.arrived())
    throw Error("the reference run fails: a step is rejected", setup.file.string(),
                "choose another `reference`, or leave the scene out");
}

std::vector<int> chosen_frames(const CompareScene& scene, const Setup& setup) {
  if (setup.run.frames <= scene.horizon)
    throw Error(fmt::format("the scene has {} frames and the horizon is {}", setup.run.frames, scene.horizon),
                setup.file.string(), "run more frames, or choose a shorter `horizon`");
  std::vector<int> frames;
  for (int k = 1; k <= scene.states; ++k) frames.push_back((setup.run.frames - scene.horizon) * k / scene.states);
  return frames;
}

// The whole run: fills in states and what it loses. False: stopped.
bool run_reference(const Setup& setup, const State& start, const CompareScene& scene, const Stop& stop,
                   CompareReference& reference) {
  const std::vector<int> frames = chosen_frames(scene, setup);
  reference.states.resize(frames.size());
  State before = start;
  before.x -= start.v / setup.run.fps;
  const auto keep = [&](const State& state) {
    for (std::size_t k = 0; k < frames.size(); ++k) {
      CommonState& common = reference.states[k];
      if (state.frame == frames[k]) {
        common.from = state;
        forget_motion(common.from.memory);
        carry_frame(before, common.from);
      }
      if (state.frame == frames[k] + 1) common.next = state.x;
      if (state.frame == frames[k] + scene.horizon) common.target = state.x;
    }
    before = state;
  };
  keep(start);
  const Flight flight = fly(setup, start, setup.run.frames, stop, keep);
  check_arrived(flight, setup);
  reference.floor.lost = energy_of(setup, start) - energy_of(setup, flight.end);
  return flight.arrived();
}

// Where the algebraic reference is from every state; nothing where it fails. False: stopped.
bool run_algebraic(const Setup& setup, const CompareScene& scene, const Stop& stop, CompareReference& reference) {
  for (CommonState& state : reference.states) {
    const Flight flight = fly(setup, state.from, scene.horizon, stop, [&](const State& at) {
      if (at.frame == state.from.frame + 1) state.algebraic_next = at.x;
    });
    if (flight.stopped) return false;
    if (flight.arrived()) state.algebraic_target = flight.end.x;
  }
  return true;
}

std::optional<Points> jittered_end(const Setup& setup, State from, double jitter, std::uint64_t seed, int horizon,
                                   const Stop& stop) {
  jitter_start(setup, jitter, seed, from);
  const Flight flight = fly(setup, from, horizon, stop);
  check_arrived(flight, setup);
  if (flight.stopped) return {};
  return flight.end.x;
}

}  // namespace

double energy_of(const Setup& setup, const State& state) {
  return energies(setup.scene, state.x, state.v, setup.drive_at(state.time).acceleration).total();
}

Setup read_compared(const CompareScene& scene, bool short_form, const std::vector<std::string>& overrides,
                    const Kinds& kinds) {
  std::vector<std::string> all;
  if (short_form) all = read_setup(scene.file, {}, kinds).short_form;
  all.insert(all.end(), scene.overrides.begin(), scene.overrides.end());
  all.insert(all.end(), overrides.begin(), overrides.end());
  return read_setup(scene.file, all, kinds);
}

std::optional<CompareReference> make_reference(const Comparison& comparison, const CompareScene& scene, bool short_form,
                                               const Stop& stop) {
  const Setup setup = with_steps(comparison, scene, short_form, fine);
  const std::optional<Start> start = prepare(setup, stop);
  if (!start) return {};
  const Setup coarser = with_steps(comparison, scene, short_form, half_as_fine);
  CompareReference reference;
  if (!run_reference(setup, start->state, scene, stop, reference)) return {};
  if (!run_algebraic(with_algebraic(comparison, scene, short_form), scene, stop, reference)) return {};
  Mean motion, steps, jittered;
  for (const CommonState& state : reference.states) {
    const Flight coarse = fly(coarser, state.from, scene.horizon, stop);
    check_arrived(coarse, coarser);
    if (coarse.stopped) return {};
    motion.add(root_mean_square(state.target - state.from.x));
    steps.add(root_mean_square(coarse.end.x - state.target));
    if (!state.from.clean) continue;  // a jitter is of clean states alone
    const auto one = jittered_end(setup, state.from, comparison.jitter, 1, scene.horizon, stop);
    const auto other = one ? jittered_end(setup, state.from, comparison.jitter, 2, scene.horizon, stop) : one;
    if (!other) return {};
    jittered.add(root_mean_square(*one - *other));
  }
  CompareFloor& floor = reference.floor;
  floor.scene = scene.name;
  floor.vertices = setup.scene.surface.vertex_count;
  floor.frames = setup.run.frames;
  floor.states = scene.states;
  floor.horizon = scene.horizon;
  floor.motion = motion.value();
  floor.steps = steps.value();
  floor.jittered = jittered.value();
  return reference;
}

std::optional<CompareErrors> errors_of(const Setup& setup, const CompareReference& reference, const RowLimits& limits,
                                       const Stop& stop) {
  CompareErrors errors;
  RowWatch row(limits, setup.scene);
  Mean temporal, temporal_one, algebraic_one, algebraic_end;
  double l2 = 0, relative = 0;
  for (const CommonState& state : reference.states) {
    Points next;
    const int horizon = reference.floor.horizon;
    const auto keep_next = [&](const State& at) {
      if (at.frame == state.from.frame + 1) next = at.x;
    };
    const Flight flight = fly(setup, state.from, horizon, stop, keep_next, &row);
    if (flight.stopped) return {};
    if (std::string why = row.trouble(flight.end.frame - state.from.frame, horizon); !why.empty()) {
      errors.trouble = "from a common state: " + why;
      return errors;
    }
    if (!flight.arrived()) {
      errors.trouble = fmt::format("rejects a step after frame {}", flight.end.frame);
      return errors;
    }
    temporal.add(root_mean_square(flight.end.x - state.target));
    temporal_one.add(root_mean_square(next - state.next));
    l2 += l2_mm(flight.end.x, state.target);
    relative += e3d(flight.end.x, state.target);
    if (state.algebraic_target.rows() > 0) {
      algebraic_one.add(root_mean_square(next - state.algebraic_next));
      algebraic_end.add(root_mean_square(flight.end.x - state.algebraic_target));
    }
    const double substep = 1 / setup.run.fps / std::max(1, flight.first.substeps);
    const auto algebraic = algebraic_error(setup, state.from, substep);
    if (!algebraic || algebraic->error < errors.algebraic) continue;
    errors.algebraic = algebraic->error;
    errors.algebraic_largest = algebraic->largest;
    if (!algebraic->reference_converged) errors.trouble = "the algebraic reference did not converge";
  }
  const auto states = static_cast<double>(reference.states.size());
  errors.temporal = temporal.value();
  errors.measures = {{"temporal_1", temporal_one.value()}, {"l2_mm", l2 / states}, {"e3d", relative / states}};
  if (algebraic_one.count > 0) {
    errors.measures["algebraic_1"] = algebraic_one.value();
    errors.measures["algebraic_end"] = algebraic_end.value();
  }
  return errors;
}

}  // namespace selvedge

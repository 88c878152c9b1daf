#include "learned/steppers/learned_stepper.hpp"

#include <utility>

#include "collision/geometry/error.hpp"
#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "learned/gradients/torch_network.hpp"
#include "learned/graph/elastic_motion.hpp"
#include "learned/graph/make_graph.hpp"
#include "learned/losses/force_input.hpp"
#include "learned/network/engine.hpp"
#include "learned/network/packed_network.hpp"
#include "learned/steppers/learned_scene.hpp"
#include "learned/steppers/learned_state.hpp"
#include "learned/steppers/step_lengths.hpp"
#include "physics/frame/bounded_step.hpp"
#include "physics/scene/joint_lists.hpp"
#include "physics/solve/energy_balance.hpp"

namespace selvedge {
namespace {

constexpr double farthest_away = 1e6;  // limit of positions and of motions in a frame [m]

bool is_near(const Points& points) { return (points.array().abs() < farthest_away).all(); }  // NaN fails too

class LearnedStepper final : public Stepper {
 public:
  LearnedStepper(const Scene& scene, const Architecture& architecture, const NetworkWeights& weights,
                 const LearnedOptions& options)
      : scene_(scene),
        features_(architecture.features),
        integration_(architecture.integration),
        passes_(architecture.passes),
        settles_(may_settle(architecture) &&
                 (options.settle || architecture.integration == Integration::relaxation_frame)),
        follows_(architecture.features.base == OutputBase::carried && options.step_lengths),
        tables_(weights.tables),
        network_(pack_network(architecture, weights, kernels_of(options.numbers))),
        torch_(torch_network_for(options.device, architecture, weights)),
        graph_scene_(learned_scene(scene, options.omitted_body_vertices).graph),
        elastic_(features_.guess_inputs || follows_ ? make_elastic(scene) : Elastic{}),
        losses_(features_.force_inputs ? loss_garment(scene) : LossGarment{}),
        rest_(make_rest_graph(graph_scene_, features_, options.centres)),
        traits_(learned_traits(architecture)),
        energy_(scene, traits_) {
    if (features_.force_inputs) set_springs(scene.springs, losses_);
  }

  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override {
    return bounded_step(traits_.name, extras.stop, [&] { return take_step(from, drive, dt, to, extras); });
  }

 private:
  StepReport take_step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&);
  bool settle(GraphState&, StepReport&);
  bool predict(GraphState, NextCloth&, StepReport&);
  void show_force(GraphState&);

  const Scene& scene_;
  FeatureOptions features_;
  Integration integration_;
  int passes_;
  bool settles_;
  bool follows_;  // the output only as far as the solver's forces agree
  FeatureTables tables_;
  std::shared_ptr<const PackedNetwork> network_;
  std::unique_ptr<TorchNetwork> torch_;  // in place of the kernels
  GraphScene graph_scene_;
  Elastic elastic_;     // of networks that see the elastic forces, or follow them
  LossGarment losses_;  // of networks with the objective's force as an input
  RestGraph rest_;
  StepperTraits traits_;
  EnergyBalance energy_;
  // Memory that is used again:
  GraphSearch search_;
  Graph graph_;
  EngineMemory engine_;
  GraphReport found_;
  LossSearch force_search_;
  AssemblyScratch scratch_;
};

// The forces at the guess that the network has among its inputs: the objective's, and the elastic ones of the scene.
void LearnedStepper::show_force(GraphState& state) {
  if (!features_.force_inputs && !features_.guess_inputs) return;
  const SeenPositions seen = seen_positions(rest_, state, features_);
  const Points guess = guess_of(rest_, state, seen, features_);
  if (features_.guess_inputs) state.elastic = elastic_motion(elastic_, graph_scene_, state.timestep, guess, scratch_);
  if (!features_.force_inputs) return;
  LossInputs inputs = loss_inputs(losses_, graph_scene_, state, seen, guess);
  inputs.is_initial = state.timestep > learned_dt * 1.5;
  inputs.contours = !state.no_cloth_edges;
  if (features_.acceleration_inputs) inputs.acceleration = &state.acceleration;
  state.force = shown_force(inputs, state.pass, features_.contour_force, force_search_);
}

// Runs all passes of a frame, each from the result of the last. Returns false if a number is not finite.
bool LearnedStepper::predict(GraphState state, NextCloth& next, StepReport& report) {
  for (state.pass = 0; state.pass < passes_; ++state.pass) {
    Stopwatch watch;
    show_force(state);
    make_graph(graph_scene_, rest_, state, features_, tables_, search_, graph_, found_);
    report.seconds.graph += watch.lap();
    if (!found_.refused.empty()) return false;
    const FeatureRows output = torch_ ? torch_->infer(graph_) : infer(*network_, graph_, engine_);
    next = integrate(rest_, state, features_, tables_.output, output);
    if (!is_near(next.x) || !is_near(next.velocity)) return false;
    if (follows_)
      take_lengths({elastic_, graph_scene_, rest_, features_, scene_.contact.thickness}, state, found_.body_pairs,
                   scratch_, next);
    report.seconds.network += watch.lap();
    if (state.pass + 1 < passes_) state.guess = next.x;
  }
  return true;
}

// The cloth falls to rest while pins and body stand still. The roll-out then starts from that position, with the
// velocity that the network gave and no history.
bool LearnedStepper::settle(GraphState& state, StepReport& report) {
  GraphState still = state;
  still.target = state.x;
  still.velocity.setZero();
  still.body_target = still.body_previous = state.body;
  still.timestep = settling_time;
  still.no_cloth_edges = still.no_space_edges = true;
  if (integration_ == Integration::relaxation_frame) {
    report.collision.pushed_out = push_out(graph_scene_.body, still.body, push_out_margin, still.x);
  } else {
    still.is_init = true;
  }
  still.previous = still.x;
  NextCloth settled;
  if (!predict(still, settled, report)) return false;
  state.x = state.previous = settled.x;
  for (int v = 0; v < scene_.surface.vertex_count; ++v)
    if (graph_scene_.types[static_cast<std::size_t>(v)] != pinned_vertex) state.target.row(v) = settled.x.row(v);
  state.velocity = settled.velocity;
  if (passes_ > 1) state.velocity.setZero();  // as our own networks are trained
  state.body_previous = state.body;
  return true;
}

StepReport LearnedStepper::take_step(const State& from, const Drive& drive, double dt, State& to,
                                     const StepExtras& extras) {
  restore_standard_arithmetic();
  if (!traits_.accepts(dt))
    throw Error("a learned stepper takes steps of 1/30 s only", "time step " + std::to_string(dt) + " s",
                "run the scene with fps: 30");
  StepReport report;
  report.by = traits_.name;
  report.substeps = 1;
  report.status = StepStatus::rejected;
  report.reason = Reason::not_finite;
  report.collision.pairs_before = from.clean ? 0 : -1;

  GraphState state = graph_state(scene_, from, drive);
  if (features_.base == OutputBase::carried) {
    const Timed timed(report.seconds.graph);
    set_carried_base(scene_, from, drive, dt, state);
  }
  if (!is_near(state.x) || !is_near(state.velocity) || !is_near(state.target) || !is_near(state.body) ||
      !is_near(state.body_target))
    return report;
  if (settles_ && begins_rollout(from)) {
    if (!settle(state, report)) return report;
    state.acceleration = free_acceleration(scene_, state.x, state.velocity / learned_dt, drive);
  }
  NextCloth next;
  if (!predict(state, next, report)) return report;

  report.reason = Reason::none;
  StepEnd end = learned_end(scene_, features_, from, drive, state, seen_positions(rest_, state, features_).x, next);
  finish_step(from, drive, dt, std::move(end), to, report);
  if (!extras.proposal) energy_.label(from, drive, to, report);
  return report;
}

}  // namespace

bool may_settle(const Architecture& architecture) { return architecture.features.base == OutputBase::motion; }

StepperTraits learned_traits(const Architecture& architecture) {
  StepperTraits traits{.name = "learned",
                       .past_frames = 1,
                       .only_dt = learned_dt,
                       .may_leave_out_cloths = false,
                       .ignores = joint_names()};
  for (const char* force : {"stiffness damping", "mass damping"}) traits.ignores.push_back(force);
  if (!sees_accelerations(architecture.features)) traits.ignores.push_back("wind");
  return traits;
}

std::unique_ptr<Stepper> make_learned_stepper(const Scene& scene, const Architecture& architecture,
                                              const NetworkWeights& weights, const LearnedOptions& options) {
  check_runnable(architecture);
  return std::make_unique<LearnedStepper>(scene, architecture, weights, options);
}

}  // namespace selvedge

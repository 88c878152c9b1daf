#include "learned/steppers/learned_stepper.hpp"

#include <cmath>
#include <utility>

#include "collision/geometry/error.hpp"
#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "collision/untangle/find_exemption.hpp"
#include "learned/graph/make_graph.hpp"
#include "learned/network/engine.hpp"
#include "learned/network/packed_network.hpp"
#include "learned/steppers/learned_scene.hpp"
#include "learned/steppers/learned_state.hpp"
#include "physics/scene/features.hpp"

namespace selvedge {
namespace {

constexpr double farthest_away = 1e6;  // of a vertex from the origin, and in a frame [m]

bool is_near(const Points& points) { return (points.array().abs() < farthest_away).all(); }  // NaN is not

class LearnedStepper final : public Stepper {
 public:
  LearnedStepper(const Scene& scene, const Architecture& architecture, const NetworkWeights& weights,
                 const LearnedOptions& options)
      : scene_(scene),
        features_(architecture.features),
        integration_(architecture.integration),
        settles_(options.settle || architecture.integration == Integration::relaxation_frame),
        tables_(weights.tables),
        network_(pack_network(architecture, weights)),
        graph_scene_(learned_scene(scene, options.omitted_body_vertices).graph),
        rest_(make_rest_graph(graph_scene_, features_, options.centres)),
        world_(make_contact_world(scene.surface, obstacle_surfaces(scene), features_of(scene).self_contact,
                                  &scene.rest)) {}

  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) override;

 private:
  bool settle(GraphState&, StepReport&);
  bool predict(const GraphState&, NextCloth&, StepReport&);
  void audit_way(const State& from, const StepEnd& end, StepReport&);

  const Scene& scene_;
  FeatureOptions features_;
  Integration integration_;
  bool settles_;
  FeatureTables tables_;
  std::shared_ptr<const PackedNetwork> network_;
  GraphScene graph_scene_;
  RestGraph rest_;
  ContactWorld world_;
  StepperTraits traits_{.name = "learned", .past_frames = 1, .only_dt = learned_dt, .may_leave_out_cloths = false};
  // Memory that is used again:
  GraphSearch search_;
  Graph graph_;
  GraphReport found_;
  AuditMemory audited_;
};

// One run of the network. False: something is not finite.
bool LearnedStepper::predict(const GraphState& state, NextCloth& next, StepReport& report) {
  Stopwatch watch;
  make_graph(graph_scene_, rest_, state, features_, tables_, search_, graph_, found_);
  report.seconds.graph += watch.lap();
  if (!found_.refused.empty()) return false;
  next = integrate(rest_, state, features_, tables_.output, infer(*network_, graph_));
  report.seconds.network += watch.lap();
  ++report.substeps;
  return is_near(next.x) && is_near(next.velocity);
}

// The cloth falls to rest while pins and body stand still. What follows starts where it has come to, with the velocity
// that the network gave it and no history.
bool LearnedStepper::settle(GraphState& state, StepReport& report) {
  GraphState still = state;
  still.target = state.x;
  still.velocity.setZero();
  still.body_target = still.body_previous = state.body;
  still.timestep = settling_time;
  if (integration_ == Integration::relaxation_frame) {
    push_out(graph_scene_.body, still.body, push_out_margin, still.x);
  } else {
    still.is_init = still.no_cloth_edges = true;
  }
  still.previous = still.x;
  NextCloth settled;
  if (!predict(still, settled, report)) return false;
  state.x = state.previous = settled.x;
  for (int v = 0; v < scene_.surface.vertex_count; ++v)
    if (graph_scene_.types[static_cast<std::size_t>(v)] != pinned_vertex) state.target.row(v) = settled.x.row(v);
  state.velocity = settled.velocity;
  state.body_previous = state.body;
  return true;
}

void LearnedStepper::audit_way(const State& from, const StepEnd& end, StepReport& report) {
  Stopwatch watch;
  const Points before = gather_nodes(from.x, from.obstacles), after = gather_nodes(end.x, end.obstacles);
  const Exemption exemption = from.clean ? Exemption{} : find_exemption(world_, before);
  report.collision.left_alone = exemption.cloth_vertices();
  report.collision.passed_through = passed_through(world_, exemption, before, after, audited_);
  report.seconds.audit += watch.lap();
}

StepReport LearnedStepper::step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) {
  restore_standard_arithmetic();
  if (!traits_.accepts(dt))
    throw Error("a learned stepper takes steps of 1/30 s only", "time step " + std::to_string(dt) + " s",
                "run the scene with fps: 30");
  StepReport report;
  report.by = traits_.name;
  report.status = StepStatus::rejected;
  report.reason = Reason::not_finite;
  report.collision.pairs_before = from.clean ? 0 : -1;

  GraphState state = graph_state(scene_, from, drive);
  if (!is_near(state.x) || !is_near(state.velocity) || !is_near(state.target) || !is_near(state.body) ||
      !is_near(state.body_target))
    return report;
  if (settles_ && begins_rollout(from) && !settle(state, report)) return report;
  NextCloth next;
  if (!predict(state, next, report)) return report;

  report.reason = Reason::none;
  StepEnd end = learned_end(scene_, from, drive, state, seen_positions(rest_, state, features_).x, next);
  audit_way(from, end, report);
  finish_step(scene_, from, drive, dt, std::move(end), audited_, to, report);
  return report;
}

}  // namespace

std::unique_ptr<Stepper> make_learned_stepper(const Scene& scene, const Architecture& architecture,
                                              const NetworkWeights& weights, const LearnedOptions& options) {
  check_runnable(architecture);
  return std::make_unique<LearnedStepper>(scene, architecture, weights, options);
}

}  // namespace selvedge

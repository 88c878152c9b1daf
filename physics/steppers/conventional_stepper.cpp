#include "physics/steppers/conventional_stepper.hpp"

#include <algorithm>
#include <cmath>

#include "collision/contact/resolve.hpp"
#include "collision/contact/room.hpp"
#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "physics/recovery/carrying.hpp"
#include "physics/recovery/parting.hpp"
#include "physics/scene/features.hpp"
#include "physics/solve/bdf2.hpp"
#include "physics/solve/contact_terms.hpp"
#include "physics/steppers/step_audit.hpp"
#include "physics/steppers/substeps.hpp"

namespace selvedge {
namespace {

constexpr double first_roughness = 8;       // of the solve that only finds impacts and normal forces
constexpr double friction_roughness = 0.2;  // of a solve with friction: sticking shows in small velocities
constexpr double contact_patience = 0.5;    // of a solve with contacts, for the next one goes on from it
constexpr int most_passes = 6;              // solves after the first one, at most
constexpr int squeezed_passes = 3;          // where there is no room: no stiffness makes any
constexpr double normal_change = 0.05;      // of what bounds friction, at most, from the last solve but one
constexpr int halvings = 2;                 // of a substep whose zones do not settle, before the last resort
constexpr double carrying_speed = 3;        // at most, of one that is drawn to where it is worn [m/s]
constexpr double firm = 1000;               // times as stiffly, where the body is free: else it holds its own shape
constexpr double rounding = 1e-14;          // of positions that are added up over substeps
constexpr int squeezed_rounds = 4;          // of zones, where there is no room
constexpr int hopeful_rounds = 12;          // of zones in a substep that may still be halved
constexpr double tearing = 10;              // times the energy of the substep: more is not left in it by impulses
constexpr double kept_way = 0.5;            // of that to the first impact, where everything stops short

// Where a substep ends. The nodes come with obstacles where they are to end and the cloth at its first guess.
struct Arrival {
  Points nodes, v;
  bool touched = false;  // something was near, met, or left alone
  int parts = 1;         // that it should be taken in
};

// How often a substep may still be cut.
struct Cuts {
  int halvings, parts;
};

ResolveOptions resolve_options(const ContactSettings& contact) {
  ResolveOptions options;
  options.thickness = contact.thickness;
  options.separation = 0.1 * contact.thickness;
  options.friction = contact.friction;
  options.self_friction = contact.self_friction;
  options.rigid_zones = contact.rigid_zones;
  return options;
}

class ConventionalStepper final : public Stepper {
 public:
  ConventionalStepper(const Scene& scene, const ConventionalOptions& options)
      : scene_(scene),
        options_(options),
        features_(features_of(scene)),
        world_(make_contact_world(scene.surface, obstacle_surfaces(scene), features_.self_contact, &scene.rest)),
        search_(world_),
        contact_(resolve_options(scene.contact)),
        inverse_mass_(inverse_masses(scene, world_.node_count)),
        solver_(scene, options.implicit_euler),
        edge_length_(mean_edge_length(scene)),
        deep_(deep_impact(scene)),
        self_crossings_(world_) {}

  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to) override;

 private:
  bool has_contact() const { return features_.self_contact || features_.obstacles; }
  NewtonReport solve(const StepProblem& problem, Points& x, StepReport& report);
  NewtonReport solve_with_contact(StepProblem& problem, bool squeezed, const Points& nodes0, Points& nodes1, Points& x,
                                  Contacts& contacts, int most_parts, int& parts, StepReport& report);
  enum class Attempt { first, squeezed, last_resort };  // squeezed: zones did not settle, but perhaps obstacles yield
  enum class Outcome { clean, hasty, unsettled, not_finite };  // hasty: met something in full motion
  Outcome substep(const Leg& leg, const Points& pins, const Drive& drive, double h, Attempt attempt, int most_parts,
                  Arrival& to, StepReport& report);
  bool torn(const StepProblem& problem, const Points& x, const Points& after);
  void stop_short(const Points& nodes0, const Points& wanted, Points& nodes1, StepReport& report);
  bool goes_on(const Leg& leg, const Points& pins, double h) const;
  bool smooth_substep(const Leg& leg, const Points& pins, const Drive& drive, Arrival& to, StepReport& report);
  bool advance(Leg& leg, const Points& nodes, const Points& pins, const Drive& drive, double h, Cuts left,
               StepReport& report);
  bool advance_in_parts(Leg& leg, const Points& nodes, const Points& pins, const Drive& drive, double h, int parts,
                        Cuts left, StepReport& report);
  int planned_substeps(const State& from, const Drive& drive, double dt, const Points& nodes) const;
  void prepare_contact(const State& from, const Drive& drive, double dt, const Points& wanted, Leg& leg,
                       StepReport& report);

  const Scene& scene_;
  ConventionalOptions options_;
  Features features_;
  ContactWorld world_;
  PairSearch search_;
  ResolveOptions contact_;
  Eigen::VectorXd inverse_mass_;
  ImplicitEuler solver_;
  double edge_length_, deep_;
  StepperTraits traits_{"conventional"};
  AuditMemory audited_;
  PathPairs path_;  // pairs near the current positions
  SelfCrossings self_crossings_;
  bool look_for_room_ = false;  // this step started with obstacles that lag, or some did not have room in it
  Parting parting_;             // of this step
};

void add(const ResolveReport& resolved, StepReport& report) {
  report.collision.impulses += resolved.impulses;
  report.collision.zones += resolved.zones;
  report.collision.shortened += resolved.shortened;
  report.collision.held_vertices += resolved.held;
  report.seconds.broad_phase += resolved.broad_phase;
  report.seconds.ccd += resolved.ccd;
  report.seconds.response += resolved.response;
}

// Solves the substep with its contacts, again and again until what it runs into besides them is shallow and friction is
// bounded by the normal forces that there are. x is the cloth in nodes1. Reports the last solve. Ends after the first
// one where that shows that the substep should be taken in parts.
NewtonReport ConventionalStepper::solve_with_contact(StepProblem& problem, bool squeezed, const Points& nodes0,
                                                     Points& nodes1, Points& x, Contacts& contacts, int most_parts,
                                                     int& parts, StepReport& report) {
  const double h = problem.h, creep = options_.implicit_euler.slip_speed * h;
  // Where nothing touches, or nothing that does moves, the first solve is likely to be the last one.
  const bool calm = !squeezed && mean_touching(contacts.terms, h * *problem.v0) < creep;
  for (int pass = 0;; ++pass) {
    problem.contacts = contacts.terms;
    problem.patience = contacts.terms.empty() ? 1 : contact_patience;
    problem.goes_on = pass > 0;
    const bool friction = features_.friction && !contacts.terms.empty();
    problem.roughness = pass > 1 || (calm && friction) ? friction_roughness : pass == 0 && !calm ? first_roughness : 1;
    const NewtonReport newton = solve(problem, x, report);
    if (!newton.finite) return newton;
    nodes1.topRows(x.rows()) = x;
    const std::vector<ContactTerm> solved = calm ? contacts.terms : std::vector<ContactTerm>{};
    const double change = lag_normal_forces(contacts.terms, x);
    if (pass == (squeezed ? squeezed_passes : most_passes)) return newton;
    ResolveReport times;
    const auto impacts = find_impacts(search_, inverse_mass_, contact_, nodes0, nodes1, path_, times);
    add(times, report);
    if (pass == 0) parts = parts_for_way(farthest_past(impacts, nodes0, nodes1), edge_length_, most_parts);
    if (parts > 1) return newton;
    if (calm && mean_touching(contacts.terms, x - *problem.x0) < creep && deepest(impacts, nodes1) < deep_ &&
        mistaken_friction(solved, contacts.terms, *problem.x0, x, creep) < normal_change)
      return newton;
    const int least = friction ? 2 : 1;
    if (pass >= least && change < normal_change && deepest(impacts, nodes1) < deep_) return newton;
    Stopwatch watch;
    add_impact_terms(scene_, world_, impacts, inverse_mass_, nodes0, nodes1, h, deep_, contacts);
    stiffen(contacts.terms, x);
    if (pass == least - 1) follow(scene_, world_, inverse_mass_, nodes0, nodes1, h, contacts);
    report.seconds.response += watch.lap();
  }
}

// Whether BDF2 goes on from the leg's history: one of this length, and no pin changes its speed by an edge a substep.
bool ConventionalStepper::goes_on(const Leg& leg, const Points& pins, double h) const {
  if (options_.integrator != Integrator::bdf2 || leg.history.h != h) return false;
  for (std::size_t k = 0; k < scene_.pins.size(); ++k) {
    const int pin = scene_.pins[k];
    const Vec3 now = row(pins, static_cast<int>(k)) - row(leg.nodes, pin);
    if ((now - (row(leg.nodes, pin) - row(leg.history.x, pin))).norm() > edge_length_) return false;
  }
  return true;
}

// The substep by BDF2. False, with `to` as it was, if it runs into something or is not finite.
bool ConventionalStepper::smooth_substep(const Leg& leg, const Points& pins, const Drive& drive, Arrival& to,
                                         StepReport& report) {
  const int n = scene_.surface.vertex_count;
  const StepStart start = bdf2_start(leg.history, leg.nodes.topRows(n), leg.v);
  const StepProblem problem{start.h, &start.x, &start.v, &pins, drive.acceleration, drive.wind, {}, 1};
  Points x = to.nodes.topRows(n);
  const NewtonReport newton = solve(problem, x, report);
  if (!newton.finite || !x.allFinite()) return false;
  Points nodes = to.nodes;
  nodes.topRows(n) = x;
  if (has_contact()) {
    ResolveReport times;
    const auto impacts = find_impacts(search_, inverse_mass_, contact_, leg.nodes, nodes, path_, times);
    add(times, report);
    if (!impacts.empty()) return false;
  }
  if (!newton.converged) report.reason = Reason::not_converged;
  report.residual = solver_.imbalance(problem, x);
  to.nodes = std::move(nodes);
  to.v = (x - start.x) / start.h;
  return true;
}

// Whether the response has taken the cloth from x to where it stores far more than there is to be stored. Impulses
// know nothing of the cloth: what is a small way to them may be many times the width of a sliver.
bool ConventionalStepper::torn(const StepProblem& problem, const Points& x, const Points& after) {
  const double moving = 0.5 * solver_.masses().dot((x - *problem.x0).rowwise().squaredNorm()) / (problem.h * problem.h);
  return solver_.potential(problem, after) > tearing * (solver_.potential(problem, x) + moving);
}

// Takes everything together as far as nothing meets.
void ConventionalStepper::stop_short(const Points& nodes0, const Points& wanted, Points& nodes1, StepReport& report) {
  ResolveReport times;
  double first = 1;
  for (const Impact& impact : find_impacts(search_, inverse_mass_, contact_, nodes0, wanted, path_, times))
    first = std::min(first, impact.time);
  nodes1 = nodes0 + kept_way * first * (wanted - nodes0);
  update_pairs(search_, contact_.thickness, nodes0, nodes1, path_);
  times.shortened = 1;
  times.held = scene_.surface.vertex_count;
  add(times, report);
}

ConventionalStepper::Outcome ConventionalStepper::substep(const Leg& leg, const Points& pins, const Drive& drive,
                                                          double h, Attempt attempt, int most_parts, Arrival& to,
                                                          StepReport& report) {
  const Points& nodes0 = leg.nodes;
  Points& nodes1 = to.nodes;
  const int n = scene_.surface.vertex_count;
  const bool smooth = attempt == Attempt::first && goes_on(leg, pins, h);
  const Points x0 = nodes0.topRows(n);
  Points x = nodes1.topRows(n);
  StepProblem problem{h, &x0, &leg.v, &pins, drive.acceleration, drive.wind, {}, 1};
  if (!has_contact()) {
    if (smooth && smooth_substep(leg, pins, drive, to, report)) return Outcome::clean;
    const NewtonReport newton = solve(problem, x, report);
    if (!newton.finite || !x.allFinite()) return Outcome::not_finite;
    if (!newton.converged) report.reason = Reason::not_converged;
    report.residual = solver_.imbalance(problem, x);
    nodes1.topRows(n) = x;
    to.v = (x - x0) / h;
    return Outcome::clean;
  }

  Stopwatch watch;
  const auto proximities =
      find_proximities(world_, pairs_within(path_, nodes0, scene_.contact.thickness), nodes0, scene_.contact.thickness);
  for (const Proximity& p : proximities) report.collision.min_gap = std::min(report.collision.min_gap, p.gap);
  report.seconds.response += watch.lap();
  to.touched = !proximities.empty() || parting_.left.any();
  if (smooth && !to.touched && smooth_substep(leg, pins, drive, to, report)) return Outcome::clean;
  watch.lap();
  Eigen::VectorXd inverse_mass = inverse_mass_;
  bool squeezed = false;
  if (look_for_room_ || attempt == Attempt::squeezed) {
    ResolveReport times;
    squeezed = make_room(search_, world_, contact_, proximities, nodes0, nodes1, path_, inverse_mass, times);
    add(times, report);
    if (attempt == Attempt::squeezed && !squeezed) return Outcome::unsettled;
    look_for_room_ = true;
    watch.lap();
  }
  AddedTerm added;
  if (!parting_.gained.empty())
    added = added_pushes(push_terms(parting_.gained, inverse_mass_, 0.1 * scene_.contact.thickness, h));
  if (!parting_.carried.empty())
    added = sum_of(std::move(added), carrying_term(parting_.carried, solver_.masses(), x0, drive.worn,
                                                   carrying_speed * h, h, parting_.left.off.empty() ? firm : 1));
  if (added.value) problem.added = &added;
  Contacts contacts = contact_terms(scene_, world_, proximities, inverse_mass_, nodes0, nodes1, h);
  // The load of a contact is what pulls at it where the cloth would go without any.
  if (!contacts.terms.empty()) bear(contacts.terms, inverse_mass_, -solver_.gradient(problem, x));
  report.seconds.response += watch.lap();
  const NewtonReport newton =
      solve_with_contact(problem, squeezed, nodes0, nodes1, x, contacts, most_parts, to.parts, report);
  if (!newton.finite) return Outcome::not_finite;
  if (to.parts > 1) return Outcome::hasty;
  report.collision.contacts = static_cast<int>(contacts.terms.size());
  watch.lap();
  report.residual = solver_.imbalance(problem, x);
  report.seconds.solve += watch.lap();
  stick(contacts.terms, inverse_mass_, x0, h, options_.implicit_euler.slip_speed * h, x);
  report.seconds.response += watch.lap();
  nodes1.topRows(n) = x;
  ResolveOptions options = contact_;
  options.last_resort = attempt == Attempt::last_resort;
  if (!options.last_resort) options.zone_rounds = hopeful_rounds;
  if (squeezed) options.zone_rounds = squeezed_rounds;
  const Points wanted = nodes1;
  const ResolveReport resolved = resolve(search_, world_, inverse_mass, options, nodes0, nodes1, path_);
  add(resolved, report);
  if (!nodes1.allFinite()) return Outcome::not_finite;
  if (!resolved.clean && !options.last_resort) return Outcome::unsettled;
  if (resolved.impulses > 0 && torn(problem, x, nodes1.topRows(n))) {
    if (!options.last_resort) return Outcome::unsettled;
    stop_short(nodes0, wanted, nodes1, report);
  }
  if (!newton.converged) report.reason = Reason::not_converged;
  to.v = (nodes1.topRows(n) - x0) / h;
  to.touched = to.touched || !contacts.terms.empty() || resolved.impulses + resolved.zones > 0;
  return Outcome::clean;
}

bool ConventionalStepper::advance_in_parts(Leg& leg, const Points& nodes, const Points& pins, const Drive& drive,
                                           double h, int parts, Cuts left, StepReport& report) {
  for (int s = 0; s < parts; ++s) {
    const double part = 1.0 / (parts - s);  // of what is left
    const Points next = leg.nodes + part * (nodes - leg.nodes);
    const Points held = pinned_rows(scene_, leg.nodes);
    const Points next_pins = held + part * (pins - held);
    if (!advance(leg, next, next_pins, drive, h / parts, left, report)) return false;
  }
  return true;
}

// Takes the leg over h to where `nodes` has the obstacles and to `pins`; in parts where it meets something in full
// motion. Where zones do not settle, obstacles that leave no room give way; if there are none the time is halved, and
// only the last halves take the last resort. False: not finite.
bool ConventionalStepper::advance(Leg& leg, const Points& nodes, const Points& pins, const Drive& drive, double h,
                                  Cuts left, StepReport& report) {
  const int n = scene_.surface.vertex_count;
  Arrival next;
  const auto attempt = [&](Attempt kind) {
    next.nodes = nodes;
    next.nodes.topRows(n) = leg.nodes.topRows(n) + h * leg.v;
    for (std::size_t k = 0; k < scene_.pins.size(); ++k) next.nodes.row(scene_.pins[k]) = pins.row(static_cast<int>(k));
    return substep(leg, pins, drive, h, kind, left.parts, next, report);
  };
  Outcome outcome = attempt(left.halvings == 0 ? Attempt::last_resort : Attempt::first);
  if (outcome == Outcome::hasty)
    return advance_in_parts(leg, nodes, pins, drive, h, next.parts, {left.halvings, 1}, report);
  left.parts = 1;
  if (outcome == Outcome::unsettled && !look_for_room_ && features_.obstacles) outcome = attempt(Attempt::squeezed);
  if (outcome == Outcome::not_finite) return false;
  if (outcome == Outcome::unsettled) {
    ++report.collision.halved_substeps;
    return advance_in_parts(leg, nodes, pins, drive, h, 2, {left.halvings - 1, 1}, report);
  }
  ++report.substeps;
  if (has_contact()) {
    Stopwatch watch;
    report.collision.passed_through += passed_through(world_, parting_.left, leg.nodes, next.nodes, audited_);
    report.seconds.audit += watch.lap();
  }
  leg.history = {};
  if (options_.integrator == Integrator::bdf2 && !next.touched)
    leg.history = {h, leg.nodes.topRows(n), std::move(leg.v)};
  leg.v = std::move(next.v);
  leg.nodes = std::move(next.nodes);
  return true;
}

NewtonReport ConventionalStepper::solve(const StepProblem& problem, Points& x, StepReport& report) {
  Stopwatch watch;
  const NewtonReport newton = solver_.solve(problem, x);
  report.iterations += newton.iterations;
  report.linear_iterations += newton.linear_iterations;
  report.seconds.solve += watch.lap();
  return newton;
}

// Putting on and recovery where the start is tangled, what contact leaves alone, and the pairs near the start.
void ConventionalStepper::prepare_contact(const State& from, const Drive& drive, double dt, const Points& wanted,
                                          Leg& leg, StepReport& report) {
  Stopwatch watch;
  Points& nodes = leg.nodes;
  const bool exempt = parting_.left.any();
  look_for_room_ = from.pinched;
  const WornPlaces where{&wanted, &drive.worn, gather_nodes(from.last_clean.x, from.last_clean.obstacles),
                         scene_.contact.thickness, dt};
  parting_ = part_at_start(world_, self_crossings_, inverse_mass_, edge_length_, from.clean, where, nodes, leg.v);
  report.collision.left_alone = parting_.left.cloth_vertices();
  if (exempt || parting_.left.any()) path_ = {};  // what was listed then is not what is to be listed now
  search_.leave_out(parting_.left.any() ? &parting_.left : nullptr);
  report.seconds.response += watch.lap();
  update_pairs(search_, scene_.contact.thickness, nodes, nodes, path_);
  report.seconds.broad_phase += watch.lap();
}

int ConventionalStepper::planned_substeps(const State& from, const Drive& drive, double dt, const Points& nodes) const {
  if (options_.substeps) return *options_.substeps;
  // The list may hold more than what touches, by what was asked before, which no checkpoint knows.
  const double thickness = scene_.contact.thickness;
  auto touching = has_contact() ? pairs_within(path_, nodes, thickness) : std::vector<NodePair>{};
  std::erase_if(touching,
                [&](const NodePair& pair) { return !(closest(pair, nodes).squared_distance < thickness * thickness); });
  return substeps_for_contact(fastest_past(touching, from, drive, dt), dt, edge_length_, options_.max_substeps);
}

StepReport ConventionalStepper::step(const State& from, const Drive& drive, double dt, State& to) {
  restore_standard_arithmetic();
  if (const auto restart = restart_of(from, drive, options_.substeps.value_or(options_.max_substeps))) {
    StepReport report = step(restart->state, drive, dt, to);
    report.collision.jumped = restart->jumped;
    return report;
  }
  StepReport report;
  report.by = traits_.name;
  const int n = scene_.surface.vertex_count;
  Leg leg{gather_nodes(from.x, from.obstacles), from.v, from.history};
  const Points wanted = gather_nodes(from.x, drive.obstacles);
  if (has_contact()) prepare_contact(from, drive, dt, wanted, leg, report);
  if (parting_.left.any() || leg.nodes.topRows(n) != from.x) leg.history = {};
  const int planned = planned_substeps(from, drive, dt, leg.nodes);
  // Cloth that left an obstacle no room will hardly do so now.
  const Cuts cuts{from.pinched ? 0 : halvings, options_.substeps ? 1 : options_.max_substeps / planned};
  if (!advance_in_parts(leg, wanted, drive.pins, drive, dt, planned, cuts, report)) {
    report.status = StepStatus::rejected;
    report.reason = Reason::not_finite;
    return report;
  }
  report.status = StepStatus::accepted;
  // The way that cloth was drawn firmly is no motion of its own: it would fly past where it is worn.
  if (parting_.left.off.empty())
    for (std::size_t v = 0; v < parting_.carried.size(); ++v)
      if (parting_.carried[v]) leg.v.row(static_cast<Eigen::Index>(v)).setZero();
  if (has_contact()) add(catch_up(search_, contact_, inverse_mass_, wanted, leg.nodes, path_), report);
  arrive(from, leg, dt, to);
  to.obstacles.resize(from.obstacles.size());
  for (std::size_t k = 0; k < from.obstacles.size(); ++k)
    to.obstacles[k] = leg.nodes.middleRows(world_.first_node[k], from.obstacles[k].rows());
  if (leg.nodes.rows() > n)
    report.collision.obstacle_lag = (leg.nodes - wanted).bottomRows(leg.nodes.rows() - n).rowwise().norm().maxCoeff();
  to.pinched = report.collision.obstacle_lag > rounding * wanted.cwiseAbs().maxCoeff();
  if (!to.pinched) report.collision.obstacle_lag = 0;
  audit_state(scene_, drive, to, audited_, report);
  if (!to.clean && drive.worn.rows() > 0)
    to.last_clean = from.clean ? LastClean{from.x, from.obstacles} : from.last_clean;
  return report;
}

}  // namespace

std::unique_ptr<Stepper> make_conventional_stepper(const Scene& scene, const ConventionalOptions& options) {
  return std::make_unique<ConventionalStepper>(scene, options);
}

}  // namespace selvedge

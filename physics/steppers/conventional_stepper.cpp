#include "physics/steppers/conventional_stepper.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "collision/contact/room.hpp"
#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "physics/frame/bounded_step.hpp"
#include "physics/scene/features.hpp"
#include "physics/scene/scene_numbers.hpp"
#include "physics/solve/bdf2.hpp"
#include "physics/solve/contact_terms.hpp"
#include "physics/solve/energy_balance.hpp"
#include "physics/solve/euler_torque.hpp"
#include "physics/steppers/carried_guess.hpp"
#include "physics/steppers/contact_stage.hpp"
#include "physics/steppers/finish_step.hpp"
#include "physics/steppers/substep_solve.hpp"
#include "physics/steppers/substeps.hpp"

namespace selvedge {
namespace {

// The data of one step.
struct StepWork {
  StepWork(const State& from, const Drive& d, const StepExtras& e, StepReport& r)
      : drive(d), extras(e), report(r), look_for_room(from.pinched) {}
  const Drive& drive;
  const StepExtras& extras;
  StepReport& report;
  std::optional<Points> carried;  // where the cloth may be at the end; absent: not asked for
  bool look_for_room;             // obstacles lag at its start, or lacked room in it
  const Exemption nothing = {};
  const Exemption& left_alone = extras.left_alone ? *extras.left_alone : nothing;
};

enum class SubstepOutcome { clean, moves_too_far, zones_not_converged, too_many_pairs, not_finite, stopped };

// Substeps of one length that are still to be taken; at their end obstacles are as in `nodes` and pins as in `pins`.
struct SubstepRun {
  Points nodes, pins;
  double h;      // of each [s]
  int count;     // substeps left
  int halvings;  // halvings that each may still take
  int parts;     // most parts of each
};

class ConventionalStepper final : public Stepper {
 public:
  ConventionalStepper(const Scene& scene, const ConventionalOptions& options)
      : scene_(scene),
        options_(options),
        features_(features_of(scene)),
        contact_(scene, options.resolve),
        solve_(scene, options.implicit_euler, options.substep, contact_),
        euler_torque_(scene),
        energy_(scene, solve_.solver().elastic()),
        edge_length_(mean_edge_length(scene)),
        traits_{.name = options.name,
                .past_frames = options.integrator == Integrator::bdf2 || options.guess == FirstGuess::carried ? 1 : 0,
                .honours_extras = true,
                .reports_contact_forces = options.contact_forces,
                .max_substeps = options.substeps.value_or(options.max_substeps)} {}

  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override {
    check_time_step(dt, "stepper `" + traits_.name + "`");
    return bounded_step(traits_.name, extras.stop, [&] { return take_step(from, drive, dt, to, extras); });
  }

 private:
  StepReport take_step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras);
  StepReport take_substeps(const State& from, const Drive& drive, double dt, int planned, State& to, const StepExtras&);
  bool has_contact() const { return features_.self_contact || features_.obstacles; }
  ResolveOptions resolve_options(const StepWork&) const;
  StepProblem problem_of(const StepWork&, const StepStart&, const Points& pins, const AddedTerm&) const;
  bool of_second_order(const StepWork&, const Substep&) const;
  void note_imbalance(const StepProblem&, const Points& x, Substep&, StepReport&);
  void set_velocities(const StepProblem&, const Points& x, Substep&) const;
  bool solve_freely(StepWork&, Substep&, const StepStart&);
  void hold_pins(StepWork&, Substep&, Points& pins);
  bool yield_obstacles(StepWork&, const std::vector<Proximity>&, Substep&);
  bool raises_energy(const StepProblem&, const Points& x, const Points& after);
  void stop_short(StepWork&, const Points& wanted, Substep&);
  SubstepOutcome respond(StepWork&, Substep&, const StepProblem&, const NewtonReport&, const Contacts&, Points& x);
  SubstepOutcome substep(StepWork&, Substep&);
  Substep begin_substep(const StepWork&, const SubstepState&, const SubstepRun& target, SubstepAttempt,
                        double time_left) const;
  void end_substep(StepWork&, Substep&&, SubstepState&);
  bool advance(StepWork&, SubstepState&, SubstepRun whole);
  void let_catch_up(StepWork&, const Points& wanted, SubstepState&);
  int planned_substeps(double dt) const;
  void begin_contact(StepWork&, const Points& nodes);

  const Scene& scene_;
  ConventionalOptions options_;
  Features features_;
  ContactStage contact_;
  SubstepSolve solve_;
  EulerTorque euler_torque_;
  EnergyBalance energy_;
  double edge_length_;
  StepperTraits traits_;
};

ResolveOptions ConventionalStepper::resolve_options(const StepWork& work) const {
  ResolveOptions options = contact_.options;
  options.stop = work.extras.stop;
  options.budget.swept -= work.report.counts.swept;
  options.budget.projected -= work.report.counts.projected;
  return options;
}

StepProblem ConventionalStepper::problem_of(const StepWork& work, const StepStart& start, const Points& pins,
                                            const AddedTerm& added) const {
  StepProblem problem{start.h, &start.x, &start.v, &pins, work.drive.acceleration, work.drive.wind, {}, 1};
  if (added.value) problem.added = &added;
  problem.stop = &work.extras.stop;
  return problem;
}

AddedTerm added_term(const StepWork& work, const Points& x0, double h) {
  return work.extras.added ? work.extras.added(x0, h) : AddedTerm{};
}

// Whether the substep is BDF2's where nothing touches. Not if a pin changes its speed by an edge per substep.
bool ConventionalStepper::of_second_order(const StepWork& work, const Substep& s) const {
  return options_.integrator == Integrator::bdf2 && s.attempt == SubstepAttempt::first && !work.extras.added &&
         !work.left_alone.any() && !pins_jump(scene_, s.start.history, s.start.nodes, s.pins, edge_length_);
}

void ConventionalStepper::note_imbalance(const StepProblem& problem, const Points& x, Substep& s, StepReport& report) {
  s.unbalanced = solve_.solver().gradient(problem, x);
  report.residual = largest_row(s.unbalanced);
}

// Velocities from the change of positions, without the torque that implicit Euler adds.
void ConventionalStepper::set_velocities(const StepProblem& problem, const Points& x, Substep& s) const {
  if (problem.starts) s.v = end_velocities(s.starts, s.solved, x, s.h);
  if (!problem.starts) s.v = (x - *problem.x0) / problem.h;
  const bool euler = problem.h == s.h && !problem.starts;
  if (euler) euler_torque_.take_back(problem, x, s.unbalanced, s.v);
}

// The substep without contact. False, with `s` unchanged, if there are impacts or it is not finite.
bool ConventionalStepper::solve_freely(StepWork& work, Substep& s, const StepStart& start) {
  const int n = scene_.surface.vertex_count;
  const AddedTerm added = added_term(work, start.x, start.h);
  StepProblem problem = problem_of(work, start, s.pins, added);
  if (s.by_vertex && start.h == s.h) solve_.choose_starts(s, {}, problem);
  Points nodes = s.nodes, x = nodes.topRows(n);
  const NewtonReport newton = solve_.once(problem, x, work.report);
  if (!newton.finite || newton.stopped || !x.allFinite()) return false;
  nodes.topRows(n) = s.solved = x;
  if (has_contact() && !solve_.impacts(s.start.nodes, nodes, work.report).empty()) return false;
  work.report.unsolved += newton.left;
  note_imbalance(problem, x, s, work.report);
  s.nodes = std::move(nodes);
  set_velocities(problem, x, s);
  return true;
}

// Lets pins give way that would be driven into prescribed motion; the report says that their motion was shortened.
void ConventionalStepper::hold_pins(StepWork& work, Substep& s, Points& pins) {
  Points nodes = s.nodes;
  ResolveReport report;
  const int held = pins_give_way(contact_, scene_.pins, resolve_options(work), work.drive, work.left_alone,
                                 s.start.nodes, nodes, report);
  add(report, work.report);
  if (held == 0) return;
  ++work.report.collision.shortened;
  work.report.collision.held_vertices += held;
  pins = nodes(scene_.pins, Eigen::all);
  s.nodes(scene_.pins, Eigen::all) = pins;
}

// Lets obstacles without room give way, in attempts that look for that. False if the attempt looked and there is room
// for all.
bool ConventionalStepper::yield_obstacles(StepWork& work, const std::vector<Proximity>& near, Substep& s) {
  s.inverse_mass = contact_.inverse_mass;
  const bool retried = s.attempt == SubstepAttempt::pinched;
  if (!work.look_for_room && !retried) return true;
  ResolveReport times;
  s.pinched = make_room(contact_.search, contact_.world, resolve_options(work), near, s.start.nodes, s.nodes,
                        contact_.path, s.inverse_mass, times);
  add(times, work.report);
  if (retried && !s.pinched) return false;
  work.look_for_room = true;
  return true;
}

// Whether the response moved the cloth from x to where it stores far more energy than there was. Impulses do not take
// elasticity into account: a small motion may be many times the width of a thin triangle.
bool ConventionalStepper::raises_energy(const StepProblem& problem, const Points& x, const Points& after) {
  const double moving =
      0.5 * solve_.solver().masses().dot((x - *problem.x0).rowwise().squaredNorm()) / (problem.h * problem.h);
  return solve_.solver().potential(problem, after) >
         options_.substep.max_energy_ratio * (solve_.solver().potential(problem, x) + moving);
}

// Moves everything along the straight path up to the first impact.
void ConventionalStepper::stop_short(StepWork& work, const Points& wanted, Substep& s) {
  double first = 1;
  for (const Impact& impact : solve_.impacts(s.start.nodes, wanted, work.report)) first = std::min(first, impact.time);
  s.nodes = s.start.nodes + options_.substep.part_to_impact * first * (wanted - s.start.nodes);
  update_pairs(contact_.search, contact_.options.thickness, s.start.nodes, s.nodes, contact_.path);
  ++work.report.collision.shortened;
  work.report.collision.held_vertices += scene_.surface.vertex_count;
}

// Static friction, then Bridson's response, from the solved positions x.
SubstepOutcome ConventionalStepper::respond(StepWork& work, Substep& s, const StepProblem& problem,
                                            const NewtonReport& newton, const Contacts& contacts, Points& x) {
  const int n = scene_.surface.vertex_count;
  if (s.by_vertex) s.solved = x;
  solve_.stick(s, problem, contacts, x, work.report);
  s.nodes.topRows(n) = x;
  ResolveOptions options = resolve_options(work);
  options.last_resort = s.attempt == SubstepAttempt::last_resort;
  if (!options.last_resort) options.zone_rounds = options_.substep.halving_zone_rounds;
  if (s.pinched) options.zone_rounds = options_.substep.pinched_zone_rounds;
  const Points wanted = s.nodes;
  const auto resolve_wanted = [&] {
    options.budget = resolve_options(work).budget;
    s.nodes = wanted;
    const ResolveReport resolved =
        resolve(contact_.search, contact_.world, s.inverse_mass, options, s.start.nodes, s.nodes, contact_.path);
    add(resolved, work.report);
    return resolved;
  };
  ResolveReport resolved = resolve_wanted();
  if (resolved.out_of_work && !options.last_resort) {  // there is no work left for another attempt
    options.last_resort = true;
    resolved = resolve_wanted();
  }
  if (resolved.stopped) return SubstepOutcome::stopped;
  if (!s.nodes.allFinite()) return SubstepOutcome::not_finite;
  if (!resolved.clean && !options.last_resort) return SubstepOutcome::zones_not_converged;
  if (resolved.impulses > 0 && raises_energy(problem, x, s.nodes.topRows(n))) {
    if (!options.last_resort) return SubstepOutcome::zones_not_converged;
    stop_short(work, wanted, s);
  }
  work.report.unsolved += newton.left;
  set_velocities(problem, s.nodes.topRows(n), s);
  if (s.by_vertex) mark_moved(wanted, s.nodes, s.contact);
  s.touched = s.touched || !contacts.terms.empty() || resolved.impulses + resolved.zones > 0;
  return SubstepOutcome::clean;
}

// Bridson, Fedkiw and Anderson 2002: an implicit solve with proximities, then impulses and zones for impacts.
SubstepOutcome ConventionalStepper::substep(StepWork& work, Substep& s) {
  const int n = scene_.surface.vertex_count;
  s.by_vertex = of_second_order(work, s);
  const bool smooth = s.by_vertex && s.start.history.h == s.h && s.start.history.free();
  const StepStart start{s.h, s.start.nodes.topRows(n), s.start.v};
  if (s.carried.rows() > 0) solve_.choose_guess(problem_of(work, start, s.pins, {}), s, work.report);
  const auto solve_smoothly = [&] { return solve_freely(work, s, bdf2_start(s.start.history, start.x, start.v)); };
  if (!has_contact())
    return (smooth && solve_smoothly()) || solve_freely(work, s, start) ? SubstepOutcome::clean
                                                                        : SubstepOutcome::not_finite;

  const std::vector<Proximity> near = solve_.near(s, work.report);
  s.touched = !near.empty() || work.left_alone.any();
  if (smooth && !s.touched && solve_smoothly()) return SubstepOutcome::clean;
  if (!yield_obstacles(work, near, s)) return SubstepOutcome::zones_not_converged;
  const AddedTerm added = added_term(work, start.x, s.h);
  StepProblem problem = problem_of(work, start, s.pins, added);
  Points x = s.nodes.topRows(n);
  Contacts contacts = solve_.loaded_contacts(s, near, problem, x, work.report);
  const NewtonReport newton = solve_.with_contact(s, problem, x, contacts, work.report);
  if (newton.stopped) return SubstepOutcome::stopped;
  if (!newton.finite) return SubstepOutcome::not_finite;
  if (s.parts > 1) return SubstepOutcome::moves_too_far;
  work.report.collision.contacts = static_cast<int>(contacts.terms.size());
  {
    const Timed timed(work.report.seconds.solve);
    note_imbalance(problem, x, s, work.report);
  }
  return respond(work, s, problem, newton, contacts, x);
}

// The substep with obstacles and pins of the target. The cloth's guess follows its velocity, or a guess of the step's
// end.
Substep ConventionalStepper::begin_substep(const StepWork& work, const SubstepState& start, const SubstepRun& target,
                                           SubstepAttempt attempt, double time_left) const {
  const int n = scene_.surface.vertex_count;
  Substep s{start, target.pins, target.h, attempt, target.parts, target.nodes};
  s.nodes.topRows(n) = start.nodes.topRows(n) + s.h * start.v;
  const auto towards = [&](const Points& end) {
    return start.nodes.topRows(n) + std::min(1.0, s.h / time_left) * (end - start.nodes.topRows(n));
  };
  if (work.extras.guess) s.nodes.topRows(n) = towards(*work.extras.guess);
  if (work.carried) s.carried = towards(*work.carried);
  s.nodes(scene_.pins, Eigen::all) = s.pins;
  if (options_.contact_forces) s.forces = std::make_shared<const ContactForces>(no_contact_forces(n));
  return s;
}

void ConventionalStepper::end_substep(StepWork& work, Substep&& s, SubstepState& now) {
  const int n = scene_.surface.vertex_count;
  ++work.report.substeps;
  if (work.report.path.substeps.empty()) work.report.path.start = now.nodes;
  work.report.path.substeps.push_back({s.nodes, work.left_alone});
  now.history = {};
  if (options_.integrator == Integrator::bdf2 && (s.by_vertex || !s.touched))
    now.history = {s.h, now.nodes.topRows(n), std::move(now.v), std::move(s.contact)};
  now.v = std::move(s.v);
  now.nodes = std::move(s.nodes);
  now.forces = std::move(s.forces);
}

// Takes all substeps. A substep whose contacts slide too far, or with impacts in fast motion, is cut into parts. One
// whose zones do not converge is tried again with obstacles that give way, then halved; only the last halves take the
// last resort. One with too many near pairs is halved too. False if the step is rejected; the report says why.
bool ConventionalStepper::advance(StepWork& work, SubstepState& now, SubstepRun whole) {
  const auto give_up = [&](Reason reason) {
    reject(reason, work.report);
    return false;
  };
  double time_left = whole.h * whole.count;
  std::vector<SubstepRun> to_do{std::move(whole)};
  while (!to_do.empty()) {
    SubstepRun& run = to_do.back();
    if (run.count == 0) {
      to_do.pop_back();
      continue;
    }
    const double part = 1.0 / run.count--;
    const Points held = now.nodes(scene_.pins, Eigen::all);
    SubstepRun target{
        now.nodes + part * (run.nodes - now.nodes), held + part * (run.pins - held), run.h, 0, run.halvings, run.parts};
    std::optional<Substep> s;
    const auto attempt = [&](SubstepAttempt kind) {
      const bool first = !s;
      s.emplace(begin_substep(work, now, target, kind, time_left));
      try {
        if (first && has_contact()) hold_pins(work, *s, target.pins);
        return substep(work, *s);
      } catch (const TooManyPairs&) {  // half of the motion may have fewer near pairs
        update_pairs(contact_.search, contact_.options.thickness, now.nodes, now.nodes, contact_.path);
        return SubstepOutcome::too_many_pairs;
      }
    };
    if (stopped(work.extras.stop)) return give_up(Reason::stopped);
    SubstepOutcome outcome = attempt(target.halvings == 0 ? SubstepAttempt::last_resort : SubstepAttempt::first);
    if (outcome == SubstepOutcome::zones_not_converged && !work.look_for_room && features_.obstacles) {
      target.parts = 1;
      outcome = attempt(SubstepAttempt::pinched);
    }
    if (outcome == SubstepOutcome::stopped || stopped(work.extras.stop)) return give_up(Reason::stopped);
    if (outcome == SubstepOutcome::not_finite) return give_up(Reason::not_finite);
    if (outcome == SubstepOutcome::clean) {
      end_substep(work, *std::move(s), now);
      time_left -= target.h;
      continue;
    }
    const bool crowded = outcome == SubstepOutcome::too_many_pairs;
    if (crowded && target.halvings == 0) return give_up(Reason::too_many_pairs);
    const bool halve = crowded || outcome == SubstepOutcome::zones_not_converged;
    if (halve) ++work.report.collision.halved_substeps;
    const int count = halve ? 2 : s->parts;
    to_do.push_back({target.nodes, target.pins, target.h / count, count, target.halvings - halve, 1});
  }
  return true;
}

// Sets what contact leaves alone, and lists the pairs near the start.
void ConventionalStepper::begin_contact(StepWork& work, const Points& nodes) {
  const Timed timed(work.report.seconds.broad_phase);
  work.report.collision.left_alone = work.left_alone.tangled_vertices();
  contact_.leave_alone(&work.left_alone);
  update_pairs(contact_.search, contact_.options.thickness, nodes, nodes, contact_.path);
}

// Obstacles that gave way go on to where they are wanted. The audit of the motion sees that too.
void ConventionalStepper::let_catch_up(StepWork& work, const Points& wanted, SubstepState& now) {
  const auto of_obstacles = [&](const Points& nodes) { return Points(nodes.bottomRows(nodes.rows() - now.v.rows())); };
  const bool lags = !has_arrived(of_obstacles(now.nodes), of_obstacles(wanted));
  const ResolveReport report =
      catch_up(contact_.search, contact_.options, contact_.inverse_mass, wanted, now.nodes, contact_.path);
  if (lags && report.clean) work.report.path.substeps.push_back({now.nodes, work.left_alone});
  add(report, work.report);
}

int ConventionalStepper::planned_substeps(double dt) const {
  const int least = options_.min_substeps.value_or(least_substeps(dt, options_.substep));
  return options_.substeps.value_or(std::min(least, options_.max_substeps));
}

StepReport ConventionalStepper::take_step(const State& from, const Drive& drive, double dt, State& to,
                                          const StepExtras& extras) {
  restore_standard_arithmetic();
  if (const auto restart = restart_of(from, drive, traits_.max_substeps)) {
    StepReport report = take_step(restart->state, drive, dt, to, extras);
    report.collision.jumped = restart->jumped;
    return report;
  }
  const int planned = planned_substeps(dt), more = options_.max_substeps;
  StepReport report = take_substeps(from, drive, dt, planned, to, extras);
  if (!report.out_of_response || more <= planned || stopped(extras.stop)) return report;
  StepReport again = take_substeps(from, drive, dt, more, to, extras);
  again.seconds += report.seconds;
  again.counts += report.counts;
  return again;
}

StepReport ConventionalStepper::take_substeps(const State& from, const Drive& drive, double dt, int planned, State& to,
                                              const StepExtras& extras) {
  StepReport report;
  report.by = traits_.name;
  report.collision.pairs_before = from.clean ? 0 : -1;
  StepWork work(from, drive, extras, report);
  const SearchTally before = contact_.search.tally();
  SubstepState now{gather_nodes(from.x, from.obstacles), from.v, step_history(from)};
  const Points wanted = gather_nodes(from.x, drive.obstacles);
  if (!now.nodes.allFinite() || !now.v.allFinite()) {
    reject(Reason::not_finite, report);
    return report;
  }
  if (has_contact()) begin_contact(work, now.nodes);
  if (work.left_alone.any()) now.history = {};
  if (options_.guess == FirstGuess::carried && !extras.guess) work.carried = carried_guess(scene_, from, drive, dt);
  // An obstacle that had no room will hardly have room now.
  const int halvings = from.pinched ? 0 : options_.substep.max_halvings,
            parts = options_.substeps ? 1 : options_.max_substeps / planned;
  if (!advance(work, now, {wanted, drive.pins, dt / planned, planned, halvings, parts})) return report;
  if (has_contact()) let_catch_up(work, wanted, now);
  report.counts.searches = contact_.search.tally().searches - before.searches;
  report.counts.candidates = contact_.search.tally().candidates - before.candidates;
  report.contact_forces = std::move(now.forces);
  report.doubts.not_converged = report.unsolved > options_.implicit_euler.tolerated_error;
  StepEnd end{now.nodes.topRows(from.x.rows()), std::move(now.v),
              split_rows(now.nodes.bottomRows(now.nodes.rows() - from.x.rows()), from.obstacles),
              blocks_of(now.history)};
  if (options_.guess == FirstGuess::carried)
    for (MemoryBlock& block : carried_memory(from, drive, end.x)) end.memory.push_back(std::move(block));
  finish_step(from, drive, dt, std::move(end), to, report);
  if (!extras.added) energy_.label(from, drive, to, report);  // recovery does work without a bound
  return report;
}

}  // namespace

std::unique_ptr<Stepper> make_conventional_stepper(const Scene& scene, const ConventionalOptions& options) {
  return std::make_unique<ConventionalStepper>(scene, options);
}

}  // namespace selvedge

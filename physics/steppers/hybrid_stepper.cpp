#include "physics/steppers/hybrid_stepper.hpp"

#include <algorithm>
#include <utility>

#include "collision/geometry/error.hpp"
#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/pair_budget.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "physics/frame/frame_audits.hpp"
#include "physics/solve/energy_balance.hpp"
#include "physics/steppers/finish_step.hpp"
#include "physics/steppers/proposal_times.hpp"
#include "physics/steppers/proposal_trust.hpp"
#include "physics/steppers/substeps.hpp"

namespace selvedge {
namespace {

bool asks_for_positions(HybridMode mode) { return mode != HybridMode::fallback; }

std::function<double()> clock_of(const HybridParts& parts) {
  if (parts.clock) return parts.clock;
  return [watch = Stopwatch(), seconds = 0.0]() mutable { return seconds += watch.lap(); };
}

void check_pair(const HybridParts& parts, HybridMode mode) {
  const StepperTraits &proposer = parts.proposer->traits(), &parent = parts.parent->traits();
  const Stepper& refiner = parts.refiner ? *parts.refiner : *parts.parent;
  const auto refuse = [](const std::string& what, const std::string& cure) {
    throw Error(what, "parts of a hybrid stepper", cure);
  };
  if (proposer.only_dt && !parent.accepts(*proposer.only_dt))
    refuse("`" + proposer.name + "` and `" + parent.name + "` take no common time step", "join others");
  if (mode == HybridMode::rough && !refiner.traits().honours_extras)
    refuse("`" + refiner.traits().name + "` takes no first guess, which the mode `rough` needs",
           "take another mode, or a stepper that honours extras");
  if (asks_for_positions(mode) && proposer.past_frames > 0 && !parts.hand_over)
    refuse("`" + proposer.name + "` remembers frames and is not told of those that it has not made",
           "take the mode `fallback`, or give a way to hand over");
}

StepperTraits joint_traits(const HybridParts& parts) {
  const StepperTraits &proposer = parts.proposer->traits(), &parent = parts.parent->traits();
  return {.name = "hybrid",
          .past_frames = std::max({1, proposer.past_frames, parent.past_frames}),
          .needs = {proposer.needs.skinned_targets || parent.needs.skinned_targets,
                    proposer.needs.bodies || parent.needs.bodies, proposer.needs.obstacles || parent.needs.obstacles},
          .only_dt = proposer.only_dt ? proposer.only_dt : parent.only_dt,
          .may_leave_out_cloths = false,
          .honours_extras = false,
          .reports_contact_forces = parent.reports_contact_forces,
          .max_substeps = parent.max_substeps,
          .ignores = parent.ignores};
}

class HybridStepper final : public Stepper {
 public:
  HybridStepper(const Scene& scene, HybridParts parts, const HybridOptions& options)
      : parts_(std::move(parts)),
        options_(options),
        guard_(scene, options.guard),
        contact_(scene),
        energy_(scene, guard_.elastic),
        traits_(joint_traits(parts_)),
        audits_(scene),
        clock_(clock_of(parts_)) {}
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) override;

 private:
  struct Work {
    const State& from;
    const Drive& drive;
    double dt;
    State& to;
    StepReport& report;
    const StopFlag& stop;
    double audited = 0;  // time of the audits, which a step without a proposal needs too
  };
  Verdict may_ask(const State& from, const Drive&, const ProposalTrust&, bool has_history) const;
  Verdict propose(Work&);
  Verdict propose_within_budget(Work&);
  bool gains_energy(Verdict, Work&);
  bool ask_proposer(Work&);
  Verdict propose_step(Work&);
  Verdict correct(Work&, Points x);
  Verdict refine(Work&, const Points& x);
  Verdict judged(const Work&, const Points& x);
  Verdict audited(Work&, Verdict free_of_contact);
  static void replace_report(StepReport next, Work&);
  void take_parent_step(Work&);
  void note_times(bool asked, bool taken, double proposal, double parent);

  HybridParts parts_;
  HybridOptions options_;
  Guard guard_;
  ContactStage contact_;
  EnergyBalance energy_;
  StepperTraits traits_;
  FrameAudits audits_;
  std::function<double()> clock_;
  ProposalTimes times_;
};

// `none`: a proposal may be asked for.
Verdict HybridStepper::may_ask(const State& from, const Drive& drive, const ProposalTrust& trust,
                               bool has_history) const {
  if (!has_history && parts_.hand_over) return Verdict::no_history;
  if (!from.clean || from.pinched || restart_of(from, drive, traits_.max_substeps)) return Verdict::tangled;
  if (trust.wait > 0) return Verdict::waiting;
  if (!options_.stop_when_slow) return Verdict::none;
  if (!times_.knows_parent()) return Verdict::waiting;
  if (!times_.may_propose(options_.extra_time)) return Verdict::too_slow;
  return Verdict::none;
}

// Of the elastic tests the mode `response` has that of stretch alone, which needs neither gradient nor search.
Verdict HybridStepper::judged(const Work& work, const Points& x) {
  const Timed timed(work.report.seconds.guard);
  GuardMeasures measures;
  if (options_.mode == HybridMode::response) return judge_stretch(guard_, work.from, x, measures);
  return judge(
      guard_, work.from, work.drive, work.dt, x,
      [&] { return touching_vertices(contact_, work.from, work.drive.obstacles, x); }, measures);
}

// Audits the new step and returns the verdict. The audit stays in the report, for make_frame.
Verdict HybridStepper::audited(Work& work, Verdict free_of_contact) {
  const double started = clock_();
  work.to.clean = judge_frame(audits_, work.from, work.drive, work.to, work.report);
  work.audited += clock_() - started;
  return is_contact_free(work.to, work.report) ? free_of_contact : Verdict::penetrating;
}

// Takes a step of the proposer, without an audit. False if the proposer rejected it.
bool HybridStepper::ask_proposer(Work& work) {
  work.report = parts_.proposer->step(work.from, work.drive, work.dt, work.to,
                                      {.stop = work.stop, .proposal = asks_for_positions(options_.mode)});
  return work.report.status == StepStatus::accepted;
}

// The proposal becomes the step if guard and audits admit it.
Verdict HybridStepper::propose_step(Work& work) {
  if (const Verdict verdict = judged(work, work.to.x); verdict != Verdict::admitted) return verdict;
  return audited(work, Verdict::admitted);
}

// Applies Bridson's response to the motion, then the common end of a step.
Verdict HybridStepper::correct(Work& work, Points x) {
  ResolveOptions options = contact_.options;
  options.last_resort = false;
  std::vector<Points> obstacles = work.drive.obstacles;
  const ResolveReport resolved = resolve_proposal(contact_, options, work.from, nullptr, x, obstacles);
  add(resolved, work.report);
  if (!resolved.clean) return Verdict::penetrating;
  if (const Verdict verdict = judged(work, x); verdict != Verdict::admitted) return verdict;
  work.report.substeps = 1;
  work.report.collision.pairs_before = 0;
  Points v = (x - work.from.x) / work.dt;
  finish_step(work.from, work.drive, work.dt, {std::move(x), std::move(v), std::move(obstacles)}, work.to, work.report);
  if (parts_.hand_over) parts_.hand_over(work.from, work.drive, work.to);
  return audited(work, Verdict::admitted);
}

// The report of what is tried next. What was tried before stays in its times and counts.
void HybridStepper::replace_report(StepReport next, Work& work) {
  next.seconds += work.report.seconds;
  next.counts += work.report.counts;
  work.report = std::move(next);
}

// Makes a solve that begins at the proposal.
Verdict HybridStepper::refine(Work& work, const Points& x) {
  StepExtras extras{.guess = &x, .stop = work.stop};
  Stepper& refiner = parts_.refiner ? *parts_.refiner : *parts_.parent;
  replace_report(refiner.step(work.from, work.drive, work.dt, work.to, extras), work);
  if (work.report.status != StepStatus::accepted) return Verdict::not_made;
  if (parts_.hand_over) parts_.hand_over(work.from, work.drive, work.to);
  return audited(work, Verdict::refined);
}

// A proposal with impossible motion is refused before a response or a solve.
Verdict HybridStepper::propose(Work& work) {
  if (!ask_proposer(work)) return Verdict::not_made;
  if (!asks_for_positions(options_.mode)) return propose_step(work);
  Points x = std::move(work.to.x);
  replace_report({}, work);
  GuardMeasures measures;
  if (const Verdict motion = judge_motion(guard_, work.from, work.dt, x, measures); motion != Verdict::admitted)
    return motion;
  return options_.mode == HybridMode::rough ? refine(work, x) : correct(work, std::move(x));
}

// A proposal with too many near pairs counts as penetrating.
Verdict HybridStepper::propose_within_budget(Work& work) {
  try {
    const Verdict verdict = propose(work);
    return gains_energy(verdict, work) ? Verdict::energy_gain : verdict;
  } catch (const TooManyPairs&) {
    return Verdict::penetrating;
  }
}

// Whether an admitted or refined step gains energy from nowhere. The stepper that made it may have said so already. An
// admitted proposal is judged again here, since a network knows only some of the scene's forces.
bool HybridStepper::gains_energy(Verdict verdict, Work& work) {
  if (verdict == Verdict::refined) return work.report.doubts.energy_gain;
  if (verdict != Verdict::admitted) return false;
  if (work.report.doubts.energy_gain) return true;
  const Timed timed(work.report.seconds.guard);
  // Other modes bound the proposal's elastic energy.
  if (options_.mode != HybridMode::response) return energy_(work.from, work.drive, work.to).from_nowhere();
  return energy_.of_proposal(work.from, work.drive, work.to, contact_.path).from_nowhere();
}

void HybridStepper::take_parent_step(Work& work) {
  replace_report(parts_.parent->step(work.from, work.drive, work.dt, work.to, {.stop = work.stop}), work);
  if (work.report.status == StepStatus::accepted && parts_.hand_over) parts_.hand_over(work.from, work.drive, work.to);
}

void HybridStepper::note_times(bool asked, bool taken, double proposal, double parent) {
  if (taken)
    times_.add_taken(proposal);
  else if (asked)
    times_.add_refused(proposal, parent);
  else
    times_.add_parent(parent);
}

StepReport HybridStepper::step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) {
  restore_standard_arithmetic();
  if (!traits_.accepts(dt))
    throw Error(
        "the stepper `" + parts_.proposer->traits().name + "` does not take steps of " + std::to_string(dt) + " s",
        "hybrid stepper", "step by " + std::to_string(traits_.only_dt.value_or(dt)) + " s");
  const double started = clock_();
  StepReport report;
  Work work{from, drive, dt, to, report, extras.stop};
  ProposalTrust trust;
  const bool has_history = read_trust(from, trust);
  Verdict verdict = may_ask(from, drive, trust, has_history);
  const bool asked = verdict == Verdict::none;
  if (asked) verdict = propose_within_budget(work);
  const bool taken = verdict == Verdict::admitted || verdict == Verdict::refined;
  const double proposed = clock_();
  if (!taken) take_parent_step(work);
  note_times(asked, taken, proposed - started - work.audited, clock_() - proposed);
  report.by = traits_.name + ": " +
              (verdict == Verdict::admitted ? parts_.proposer->traits().name : parts_.parent->traits().name);
  report.fell_back = asked && !taken;
  report.verdict = verdict;
  if (report.status == StepStatus::accepted)
    remember(!asked  ? after_wait(trust)
             : taken ? after_admission(trust, options_.admitted_to_halve)
                     : after_refusal(trust, options_.longest_stretch),
             to);
  return report;
}

}  // namespace

std::unique_ptr<Stepper> make_hybrid_stepper(const Scene& scene, HybridParts parts, const HybridOptions& options) {
  check_pair(parts, options.mode);
  return std::make_unique<HybridStepper>(scene, std::move(parts), options);
}

}  // namespace selvedge

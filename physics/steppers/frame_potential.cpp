#include "physics/steppers/frame_potential.hpp"

#include <utility>

#include "collision/geometry/floating_point.hpp"
#include "physics/frame/bounded_step.hpp"
#include "physics/steppers/finish_step.hpp"
#include "physics/steppers/recovering_stepper.hpp"
#include "physics/steppers/substep_solve.hpp"

namespace selvedge {

// A stepper that stays where it is, and makes the terms of the potential from what it is asked to step.
class FramePotential::Probe final : public Stepper {
 public:
  Probe(const Scene& scene, const ConventionalOptions& options)
      : scene_(scene), stage_(scene, options.resolve), solve_(scene, options.implicit_euler, options.substep, stage_) {}

  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras& extras) override {
    return bounded_step(traits_.name, extras.stop, [&] { return begin(from, drive, dt, to, extras); });
  }
  void lag(const Points& x) { lag_normal_forces(contacts_.terms, x); }
  double at(const Points& x, Points* gradient) {
    StepProblem problem = problem_without_contact();
    problem.contacts = contacts_.terms;
    if (gradient) *gradient += solve_.solver().gradient(problem, x);
    return solve_.solver().potential(problem, x);
  }
  int contacts() const { return static_cast<int>(contacts_.terms.size()); }

 private:
  StepReport begin(const State& from, const Drive&, double dt, State& to, const StepExtras&);
  StepProblem problem_without_contact() const {
    StepProblem problem{h_, &x0_, &start_.v, &pins_, acceleration_, wind_, {}};
    if (added_.value) problem.added = &added_;
    return problem;
  }

  const Scene& scene_;
  ContactStage stage_;
  SubstepSolve solve_;
  SubstepState start_;
  Points x0_, pins_;
  Vec3 acceleration_ = Vec3::Zero(), wind_ = Vec3::Zero();
  double h_ = 1;
  Exemption left_alone_;
  AddedTerm added_;
  Contacts contacts_;
  StepperTraits traits_{.name = "potential", .honours_extras = true};
};

StepReport FramePotential::Probe::begin(const State& from, const Drive& drive, double dt, State& to,
                                        const StepExtras& extras) {
  restore_standard_arithmetic();
  StepReport report;
  report.by = traits_.name;
  start_ = {gather_nodes(from.x, from.obstacles), from.v};
  x0_ = from.x;
  pins_ = drive.pins;
  acceleration_ = drive.acceleration;
  wind_ = drive.wind;
  h_ = dt;
  added_ = extras.added ? extras.added(from.x, dt) : AddedTerm{};
  contacts_ = {};
  Substep substep{start_, pins_, dt, SubstepAttempt::first, 1, gather_nodes(from.x + dt * from.v, drive.obstacles)};
  substep.nodes(scene_.pins, Eigen::all) = pins_;
  if (!start_.nodes.allFinite() || !substep.nodes.allFinite()) {
    reject(Reason::not_finite, report);
    return report;
  }
  left_alone_ = extras.left_alone ? *extras.left_alone : Exemption{};
  stage_.leave_alone(&left_alone_);
  stage_.path = {};  // pairs of an earlier frame would be listed in another order
  update_pairs(stage_.search, stage_.options.thickness, start_.nodes, start_.nodes, stage_.path);
  const auto near = solve_.near(substep, report);
  contacts_ =
      solve_.loaded_contacts(substep, near, problem_without_contact(), substep.nodes.topRows(x0_.rows()), report);
  finish_step(from, drive, dt, {from.x, from.v, from.obstacles}, to, report);
  return report;
}

FramePotential::FramePotential(const Scene& scene, const ConventionalOptions& options) {
  auto probe = std::make_unique<Probe>(scene, options);
  probe_ = probe.get();
  stepper_ = make_recovering_stepper(scene, std::move(probe));
}

FramePotential::~FramePotential() = default;

bool FramePotential::begin(const State& from, const Drive& drive, double dt) {
  State to;
  return stepper_->step(from, drive, dt, to).status == StepStatus::accepted;
}

void FramePotential::lag(const Points& x) { probe_->lag(x); }

double FramePotential::at(const Points& x, Points* gradient) { return probe_->at(x, gradient); }

int FramePotential::contacts() const { return probe_->contacts(); }

}  // namespace selvedge

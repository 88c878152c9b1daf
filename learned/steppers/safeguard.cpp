#include "learned/steppers/safeguard.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/pair_budget.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "learned/steppers/learned_state.hpp"

namespace selvedge {
namespace {

ResolveOptions safeguard_resolve_options(const SafeguardOptions& options) {
  ResolveOptions resolve;
  resolve.thickness = options.thickness;
  resolve.separation = 0.1 * options.thickness;
  resolve.friction = resolve.self_friction = 0;
  resolve.impulse_rounds = 10;
  resolve.last_resort = false;
  return resolve;
}

class SafeguardedStepper final : public Stepper {
 public:
  SafeguardedStepper(const Scene& scene, std::unique_ptr<Stepper> inner, const SafeguardOptions& options)
      : inner_(std::move(inner)), safeguard_(scene, options), traits_(inner_->traits()) {
    traits_.name = "safeguarded " + traits_.name;
    traits_.may_leave_out_cloths = false;
  }
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double dt, State& to, const StepExtras&) override;

 private:
  std::unique_ptr<Stepper> inner_;
  Safeguard safeguard_;
  StepperTraits traits_;
};

StepReport SafeguardedStepper::step(const State& from, const Drive& drive, double dt, State& to,
                                    const StepExtras& extras) {
  StepReport report = inner_->step(from, drive, dt, to, extras);
  report.by = traits_.name;
  if (report.status != StepStatus::accepted) return report;
  Stopwatch watch;
  const Points proposed = to.x;
  const SafeguardReport kept = safeguard_(from.x, to.x);
  report.collision.impulses += kept.impulses;
  report.collision.zones += kept.zones;
  report.seconds.response += watch.lap();
  if (!kept.kept) {
    report.status = StepStatus::rejected;
    report.reason = Reason::penetrating;
    return report;
  }
  const Points change = to.x - proposed;
  if (change.isZero(0)) return report;
  to.v += change / dt;
  change_carried_velocity(change, to);
  report.doubts = {};
  report.audit.reset();
  return report;
}

}  // namespace

Safeguard::Safeguard(const Scene& scene, const SafeguardOptions& options)
    : options_(options),
      resolve_(safeguard_resolve_options(options)),
      surface_(scene.surface),
      world_(make_contact_world(scene.surface, {}, true, &scene.rest)),
      search_(world_),
      inverse_mass_(inverse_masses(scene, world_.node_count)) {}

SafeguardReport Safeguard::operator()(const Points& from, Points& to) {
  try {
    return respond(from, to);
  } catch (const TooManyPairs& error) {
    SafeguardReport report;
    report.kept = false;
    report.why = error.problem();
    return report;
  }
}

SafeguardReport Safeguard::respond(const Points& from, Points& to) {
  restore_standard_arithmetic();
  SafeguardReport report;
  const auto give_up = [&](const std::string& why) {
    report.kept = false;
    report.why = why;
    return report;
  };
  if (!to.allFinite()) return give_up("a position is not finite");
  if (!intersecting_pairs(surface_, from, intersections_).empty()) return give_up("the cloth intersects itself before");
  const Points proposed = to;
  const ResolveReport resolved = resolve(search_, world_, inverse_mass_, resolve_, from, to, path_);
  report.impulses = resolved.impulses;
  report.zones = resolved.zones;
  if (options_.most_contacts > 0 && resolved.found > options_.most_contacts) return give_up("too many contacts");
  if (options_.largest_zone > 0 && resolved.largest_zone > options_.largest_zone)
    return give_up("an impact zone is too large");
  if (!to.allFinite()) return give_up("a position is not finite after the response");
  if (options_.largest_impulse > 0 && (to - proposed).rowwise().norm().maxCoeff() > options_.largest_impulse)
    return give_up("an impulse is too large");
  if (!resolved.clean) return give_up("impact zones do not settle");
  return report;
}

std::unique_ptr<Stepper> make_safeguarded(const Scene& scene, std::unique_ptr<Stepper> inner,
                                          const SafeguardOptions& options) {
  return std::make_unique<SafeguardedStepper>(scene, std::move(inner), options);
}

}  // namespace selvedge

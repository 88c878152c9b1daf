#include "learned/steppers/safeguard.hpp"

#include "collision/geometry/floating_point.hpp"
#include "collision/geometry/pair_budget.hpp"

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
    return {false, error.problem()};
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

}  // namespace selvedge

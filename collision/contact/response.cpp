#include "collision/contact/response.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/contact/contact_normal.hpp"
#include "collision/geometry/distance.hpp"
#include "collision/geometry/factorisations.hpp"
#include "collision/geometry/stop_scope.hpp"

namespace selvedge {
namespace {

constexpr double no_inertia = 1e-14;  // ratio of principal moments below which nodes count as on a line

Vec3 weighted(const Eigen::Vector4d& w, const std::array<Vec3, 4>& p) {
  return w[0] * p[0] + w[1] * p[1] + w[2] * p[2] + w[3] * p[3];
}

void push(const Impact& impact, const Eigen::VectorXd& inverse_mass, const Vec3& impulse, Points& x1) {
  for (int i = 0; i < 4; ++i) {
    const int node = impact.pair.nodes[i];
    x1.row(node) += impact.weights[i] * inverse_mass[node] * impulse.transpose();
  }
}

// Relative motion of the pair over the step, perpendicular to its normal.
Vec3 slip_of(const Impact& impact, const Points& x0, const Points& x1) {
  const Vec3 motion =
      weighted(impact.weights, corners(impact.pair, x1)) - weighted(impact.weights, corners(impact.pair, x0));
  return motion - motion.dot(impact.normal) * impact.normal;
}

// Sets the friction impulse to the one that stops the slip, bounded by Coulomb's cone.
void rub(Impact& impact, double give, const Eigen::VectorXd& inverse_mass, const Points& x0, Points& x1) {
  Vec3 wanted = impact.tangential - slip_of(impact, x0, x1) / give;
  const double bound = impact.friction * impact.multiplier, size = wanted.norm();
  if (size > bound) wanted *= bound / size;
  push(impact, inverse_mass, wanted - impact.tangential, x1);
  impact.tangential = wanted;
}

}  // namespace

double impact_gap(const Impact& impact, const Points& x) {
  return impact.normal.dot(weighted(impact.weights, corners(impact.pair, x)));
}

double compliance(const Impact& impact, const Eigen::VectorXd& inverse_mass) {
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += impact.weights[i] * impact.weights[i] * inverse_mass[impact.pair.nodes[i]];
  return sum;
}

double mean_inverse_mass(const Eigen::VectorXd& inverse_mass) {
  const auto free = (inverse_mass.array() > 0).count();
  return free > 0 ? inverse_mass.sum() / static_cast<double>(free) : 0.0;
}

std::optional<Impact> find_impact(const NodePair& pair, const Points& x0, const Points& x1, double separation,
                                  const ContactWorld* world) {
  const auto from = corners(pair, x0), to = corners(pair, x1);
  const std::optional<double> time = time_of_contact(pair.kind, from, to, separation);
  if (!time) return std::nullopt;
  std::array<Vec3, 4> then;
  for (int i = 0; i < 4; ++i) then[i] = from[i] + *time * (to[i] - from[i]);
  const Closest start = closest(pair.kind, from);
  Closest meeting = closest(pair.kind, then);
  Vec3 between = weighted(meeting.weights, then);
  if (between.squaredNorm() < 1e-24 * separation * separation) {
    meeting = start;
    between = weighted(start.weights, from);
  }
  Impact impact{pair, meeting.weights, between.normalized(), *time};
  if (world) impact.normal = contact_normal(*world, pair, meeting.weights, between, x0, x1, *time);
  // The target is twice the separation, to leave a margin; a pair that starts closer keeps its distance.
  impact.target = std::min(2 * separation, std::sqrt(start.squared_distance));
  // A pair that comes too near and parts again may end above this target; then the target is a little more than its
  // end.
  const double end = impact_gap(impact, x1);
  if (end >= impact.target) impact.target = end + 0.25 * separation;
  return impact;
}

void apply_impulse(Impact& impact, const Eigen::VectorXd& inverse_mass, const Points& x0, Points& x1) {
  const double give = compliance(impact, inverse_mass);
  const double lack = impact.target - impact_gap(impact, x1);
  if (give <= 0 || lack <= 0) return;
  const double normal_impulse = lack / give;
  impact.multiplier += normal_impulse;
  push(impact, inverse_mass, normal_impulse * impact.normal, x1);
  const Vec3 slip = slip_of(impact, x0, x1);
  const double length = slip.norm();
  if (length > 0) push(impact, inverse_mass, -std::min(impact.friction * normal_impulse / length, 1 / give) * slip, x1);
}

Projection project_zone(std::span<Impact*> impacts, const Eigen::VectorXd& inverse_mass, const Points& x0, Points& x1,
                        int max_sweeps, double tolerance) {
  constexpr int patience = 25;  // sweeps without progress; impacts that contradict each other never reach their targets
  double violation = 0, earlier = std::numeric_limits<double>::infinity();
  std::int64_t free = 0, moved = 0;
  for (const Impact* impact : impacts)
    free += std::ranges::count_if(impact->pair.nodes, [&](int node) { return inverse_mass[node] > 0; });
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    if (sweep % patience == 0) {
      if (violation > 0.9 * earlier) break;
      if (sweep > 0) earlier = violation;
    }
    check_stop();
    moved += free;
    violation = 0;
    for (Impact* impact : impacts) {
      const double give = compliance(*impact, inverse_mass);
      if (give <= 0) continue;
      const double lack = impact->target - impact_gap(*impact, x1);
      const double change = std::max(lack / give, -impact->multiplier);
      if (change != 0) {
        impact->multiplier += change;
        push(*impact, inverse_mass, change * impact->normal, x1);
        violation = std::max(violation, lack);
      }
      if (impact->friction > 0 && (impact->multiplier > 0 || impact->tangential != Vec3::Zero()))
        rub(*impact, give, inverse_mass, x0, x1);
    }
    if (violation < tolerance) break;
  }
  return {violation, moved};
}

Vec3 angular_velocity(const Mat3& inertia, const Vec3& momentum) {
  const Spectrum3 spectrum = symmetric_spectrum3(inertia);
  Vec3 turn = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = spectrum.vectors.col(k);
    if (spectrum.values[k] > no_inertia * spectrum.values[2]) turn += axis.dot(momentum) / spectrum.values[k] * axis;
  }
  return turn;
}

void rigidify_zone(std::span<const int> nodes, const Eigen::VectorXd& inverse_mass, const Points& x0, Points& x1) {
  double mass = 0;
  Vec3 centre = Vec3::Zero(), moved = Vec3::Zero();
  for (const int node : nodes) {
    mass += 1 / inverse_mass[node];
    centre += row(x0, node) / inverse_mass[node];
    moved += (row(x1, node) - row(x0, node)) / inverse_mass[node];
  }
  centre /= mass;
  moved /= mass;
  Vec3 momentum = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  for (const int node : nodes) {
    const Vec3 arm = row(x0, node) - centre;
    momentum += arm.cross(row(x1, node) - row(x0, node) - moved) / inverse_mass[node];
    inertia += (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose()) / inverse_mass[node];
  }
  const Vec3 turn = angular_velocity(inertia, momentum);
  const double angle = turn.norm();
  const Mat3 rotation = angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Mat3(Mat3::Identity());
  for (const int node : nodes) x1.row(node) = (centre + moved + rotation * (row(x0, node) - centre)).transpose();
}

}  // namespace selvedge

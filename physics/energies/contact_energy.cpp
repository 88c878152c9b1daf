#include "physics/energies/contact_energy.hpp"

namespace selvedge {

ContactForce contact_force(const ContactTerm& term, double gap) {
  const double s = term.target - gap, e = term.softness, k = term.stiffness;
  if (s <= 0) return {};
  if (s < e) return {k * s * s * s / (6 * e), -k * s * s / (2 * e), k * s / e};
  return {k * (s * s / 2 - e * s / 2 + e * e / 6), -k * (s - e / 2), k};
}

double contact_gap(const ContactTerm& term, const Points& x) {
  double gap = term.offset;
  for (int i = 0; i < 4; ++i)
    if (term.nodes[i] >= 0) gap += term.weights[i] * term.normal.dot(row(x, term.nodes[i]));
  return gap;
}

FrictionForce friction_force(const ContactTerm& term, const Vec3& slip, double slip_width) {
  const double bound = term.friction * term.normal_force, y = slip.norm(), e = slip_width;
  if (y >= e) return {bound * y, y > 0 ? bound / y : 0};
  const double r = y / e;
  return {bound * e * (r * r - r * r * r / 3 + 1.0 / 3), bound * (2 - r) / e};
}

Vec3 contact_slip(const ContactTerm& term, const Points& x0, const Points& x) {
  Vec3 motion = term.drift;
  for (int i = 0; i < 4; ++i)
    if (term.nodes[i] >= 0) motion += term.weights[i] * (row(x, term.nodes[i]) - row(x0, term.nodes[i]));
  return motion - term.normal.dot(motion) * term.normal;
}

}  // namespace selvedge

#include "physics/contact_terms.hpp"

#include <algorithm>

namespace selvedge {
namespace {

constexpr double contact_stiffness = 200;  // times mass / h^2
constexpr double overlap_removed = 0.1;    // of the overlap, at most, a step
constexpr double onset = 0.02;             // width of the smooth onset, of the thickness

double compliance(const ContactTerm& term, const Eigen::VectorXd& inverse_mass) {
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    if (term.nodes[i] >= 0) sum += term.weights[i] * term.weights[i] * inverse_mass[term.nodes[i]];
  return sum;
}

// What proximities and impacts have in common: the linearised gap and the slip, with what belongs to obstacles folded
// in. False if nothing in the pair can move.
bool linearise(const Scene& scene, const ContactWorld& world, const NodePair& pair, const Eigen::Vector4d& weights,
               const Eigen::VectorXd& inverse_mass, const Points& nodes0, const Points& nodes1, double h,
               ContactTerm& term) {
  bool obstacle = false;
  for (int i = 0; i < 4; ++i) {
    const int node = pair.nodes[i];
    if (world.is_cloth(node)) {
      term.nodes[i] = node;
      term.weights[i] = weights[i];
      continue;
    }
    obstacle = true;
    term.offset += weights[i] * term.normal.dot(row(nodes1, node));
    term.drift += weights[i] * (row(nodes1, node) - row(nodes0, node));
  }
  const double give = compliance(term, inverse_mass);
  if (give <= 0) return false;
  term.stiffness = contact_stiffness / (give * h * h);
  term.friction = obstacle ? scene.contact.friction : scene.contact.self_friction;
  return true;
}

}  // namespace

std::vector<ContactTerm> contact_terms(const Scene& scene, const ContactWorld& world,
                                       std::span<const Proximity> proximities, const Eigen::VectorXd& inverse_mass,
                                       const Points& nodes0, const Points& nodes1, double h) {
  std::vector<ContactTerm> terms;
  terms.reserve(proximities.size());
  for (const Proximity& p : proximities) {
    ContactTerm term;
    term.normal = p.normal;
    term.target = std::min(p.rest_gap, p.gap + overlap_removed * (p.rest_gap - p.gap));
    term.softness = onset * p.rest_gap;
    if (linearise(scene, world, p.pair, p.weights, inverse_mass, nodes0, nodes1, h, term)) terms.push_back(term);
  }
  return terms;
}

void add_impact_terms(const Scene& scene, const ContactWorld& world, std::span<const Impact> impacts,
                      std::span<const Proximity> owned, const Eigen::VectorXd& inverse_mass, const Points& nodes0,
                      const Points& nodes1, double h, std::vector<ContactTerm>& terms) {
  std::vector<NodePair> pairs;
  for (const Proximity& p : owned) pairs.push_back(p.pair);
  std::sort(pairs.begin(), pairs.end());
  for (const Impact& impact : impacts) {
    if (std::binary_search(pairs.begin(), pairs.end(), impact.pair)) continue;
    ContactTerm term;
    term.normal = impact.normal;
    term.target = std::clamp(impact_gap(impact, nodes0), 0.0, 0.5 * scene.contact.thickness);
    term.softness = onset * scene.contact.thickness;
    if (linearise(scene, world, impact.pair, impact.weights, inverse_mass, nodes0, nodes1, h, term))
      terms.push_back(term);
  }
}

std::vector<ContactTerm> push_terms(std::span<const Separation> separations, const Eigen::VectorXd& inverse_mass,
                                    double softness, double h) {
  std::vector<ContactTerm> terms;
  for (const Separation& s : separations) {
    ContactTerm term;
    if (s.count > static_cast<int>(term.nodes.size())) continue;
    std::copy_n(s.vertex.begin(), term.nodes.size(), term.nodes.begin());
    std::copy_n(s.weight.begin(), term.weights.size(), term.weights.begin());
    term.normal = s.direction;
    term.target = s.least;
    term.softness = softness;
    const double give = compliance(term, inverse_mass);
    if (give <= 0) continue;
    term.stiffness = contact_stiffness / (give * h * h);
    terms.push_back(term);
  }
  return terms;
}

void lag_normal_forces(std::vector<ContactTerm>& terms, const Points& x) {
  for (ContactTerm& term : terms) term.normal_force = -contact_force(term, contact_gap(term, x)).first;
}

void stick(std::span<const ContactTerm> terms, const Eigen::VectorXd& inverse_mass, const Points& x0, double h,
           double slip_width, Points& x) {
  constexpr int sweeps = 4;
  std::vector<double> budget(terms.size(), 0.0);  // tangential impulse times h still allowed [kg m]
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const Vec3 slip = contact_slip(terms[k], x0, x);
    if (slip.norm() > slip_width) continue;  // slides: the solve has used the whole bound
    const double used = friction_force(terms[k], slip, slip_width).factor * slip.norm();
    budget[k] = std::max(0.0, terms[k].friction * terms[k].normal_force - used) * h * h;
  }
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t k = 0; k < terms.size(); ++k) {
      if (budget[k] <= 0) continue;
      const ContactTerm& term = terms[k];
      const Vec3 slip = contact_slip(term, x0, x);
      const double length = slip.norm();
      if (length == 0) continue;
      const double impulse = std::min(budget[k], length / compliance(term, inverse_mass));
      budget[k] -= impulse;
      for (int i = 0; i < 4; ++i)
        if (term.nodes[i] >= 0)
          x.row(term.nodes[i]) -= term.weights[i] * inverse_mass[term.nodes[i]] * impulse / length * slip.transpose();
    }
}

}  // namespace selvedge

#include "physics/solve/contact_terms.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "collision/contact/contact_normal.hpp"

namespace selvedge {
namespace {

constexpr double least_free_weight = 0.01;

// The inverse effective mass of a gap [1/kg]. 0 if no free node has a weight of at least 0.01, since it would have to
// move a hundred times as far as the gap.
double compliance(std::span<const int> nodes, std::span<const double> weights, const Eigen::VectorXd& inverse_mass) {
  double sum = 0, largest_free = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] < 0 || inverse_mass[nodes[i]] <= 0) continue;
    sum += weights[i] * weights[i] * inverse_mass[nodes[i]];
    largest_free = std::max(largest_free, std::abs(weights[i]));
  }
  return largest_free < least_free_weight ? 0 : sum;
}

double compliance(const ContactTerm& term, const Eigen::VectorXd& inverse_mass) {
  return compliance(term.nodes, term.weights, inverse_mass);
}

// The common part of terms of proximities and impacts: the linearised gap and the slip, with obstacle nodes as
// constants. False if no node of the pair can move.
bool linearise(const ContactMotion& motion, const NodePair& pair, const Eigen::Vector4d& weights, ContactTerm& term) {
  bool obstacle = false;
  for (int i = 0; i < 4; ++i) {
    const int node = pair.nodes[i];
    if (motion.world.is_cloth(node)) {
      term.nodes[i] = node;
      term.weights[i] = weights[i];
      continue;
    }
    obstacle = true;
    term.offset += weights[i] * term.normal.dot(row(motion.nodes1, node));
    term.drift += weights[i] * (row(motion.nodes1, node) - row(motion.nodes0, node));
  }
  const double give = compliance(term, motion.inverse_mass);
  if (give <= 0) return false;
  term.stiffness = motion.options.stiffness / (give * motion.h * motion.h);
  term.stiffest = motion.options.max_stiffening * term.stiffness;
  term.friction = obstacle ? motion.scene.contact.friction : motion.scene.contact.self_friction;
  return true;
}

}  // namespace

Contacts contact_terms(const ContactMotion& motion, std::span<const Proximity> proximities) {
  const ContactTermOptions& options = motion.options;
  const double share = std::min(1.0, motion.h / ContactTermOptions::full_step);  // of what a step removes or admits
  Contacts contacts;
  for (const Proximity& p : proximities) {
    const double lift = share * options.overlap_removed * (p.rest_gap - p.gap);
    ContactTerm term;
    term.normal = p.normal;
    term.target = std::min(p.rest_gap, p.gap + lift);
    term.softness = options.onset * p.rest_gap;
    // Loaded cloth comes to rest where sinking and lifting balance: at half the rest gap.
    term.sink = share * std::max(options.overlap_removed * p.gap, options.load_sink * p.rest_gap);
    if (!linearise(motion, p.pair, p.weights, term)) continue;
    contacts.pairs.push_back(p.pair);
    contacts.terms.push_back(term);
  }
  return contacts;
}

void add_impact_terms(const ContactMotion& motion, std::span<const Impact> impacts, double deep, Contacts& contacts) {
  const ContactTermOptions& options = motion.options;
  const double thickness = motion.scene.contact.thickness;
  std::vector<std::pair<NodePair, std::size_t>> owned;
  for (std::size_t k = 0; k < contacts.pairs.size(); ++k) owned.emplace_back(contacts.pairs[k], k);
  std::sort(owned.begin(), owned.end());
  for (const Impact& impact : impacts) {
    const bool is_deep = impact.target - impact_gap(impact, motion.nodes1) > deep;
    const auto owner = std::lower_bound(owned.begin(), owned.end(), std::pair(impact.pair, std::size_t{0}));
    const bool has_term = owner != owned.end() && owner->first == impact.pair;
    if (has_term && !is_deep) continue;
    ContactTerm term;
    term.normal = impact.normal;
    term.target = std::clamp(impact_gap(impact, motion.nodes0), 0.0, 0.5 * thickness);
    term.softness = options.onset * thickness;
    term.sink = std::max(options.impact_sink * term.target, options.load_sink * thickness);
    if (!linearise(motion, impact.pair, impact.weights, term)) continue;
    if (has_term) {
      const ContactTerm& old = contacts.terms[owner->second];
      term.stiffness = std::max(term.stiffness, old.stiffness);
      term.stiffest = std::max(term.stiffest, old.stiffest);
      contacts.terms[owner->second] = term;
    } else {
      contacts.pairs.push_back(impact.pair);
      contacts.terms.push_back(term);
    }
  }
}

double push_compliance(const Separation& push, const Eigen::VectorXd& inverse_mass) {
  const auto count = static_cast<std::size_t>(push.count);
  return compliance(std::span(push.vertex).first(count), std::span(push.weight).first(count), inverse_mass);
}

std::vector<ContactTerm> push_terms(std::span<const Separation> separations, const Eigen::VectorXd& inverse_mass,
                                    double softness, double h, const ContactTermOptions& options) {
  std::vector<ContactTerm> terms;
  for (const Separation& s : separations) {
    ContactTerm term;
    if (s.count > static_cast<int>(term.nodes.size())) continue;
    std::copy_n(s.vertex.begin(), term.nodes.size(), term.nodes.begin());
    std::copy_n(s.weight.begin(), term.weights.size(), term.weights.begin());
    term.normal = s.direction;
    term.target = s.least;
    term.softness = softness;
    const double give = push_compliance(s, inverse_mass);
    if (give <= 0) continue;
    term.stiffness = options.stiffness / (give * h * h);
    terms.push_back(term);
  }
  return terms;
}

AddedTerm added_pushes(std::vector<ContactTerm> terms) {
  const auto shared = std::make_shared<const std::vector<ContactTerm>>(std::move(terms));
  return {[shared](const Points& x) {
            double energy = 0;
            for (const ContactTerm& term : *shared) energy += contact_force(term, contact_gap(term, x)).energy;
            return energy;
          },
          [shared](const Points& x, Points& gradient, std::vector<ContactBlock>& blocks) {
            for (const ContactTerm& term : *shared) {
              const ContactForce push = contact_force(term, contact_gap(term, x));
              for (std::size_t k = 0; k < term.nodes.size(); ++k)
                if (term.nodes[k] >= 0)
                  gradient.row(term.nodes[k]) += push.first * term.weights[k] * term.normal.transpose();
              blocks.push_back({term.nodes, term.weights, term.normal, push.second, 0});
            }
          }};
}

double lag_normal_forces(std::vector<ContactTerm>& terms, const Points& x) {
  double sum = 0, before = 0;
  for (ContactTerm& term : terms) {
    before += term.friction * term.normal_force;
    term.normal_force = -contact_force(term, contact_gap(term, x)).first;
    sum += term.friction * term.normal_force;
  }
  return sum > 0 ? std::abs(sum - before) / sum : 0;
}

double mean_touching(std::span<const ContactTerm> terms, const Points& motion) {
  double sum = 0;
  int count = 0;
  for (const ContactTerm& term : terms)
    for (const int node : term.nodes)
      if (node >= 0) {
        sum += motion.row(node).squaredNorm();
        ++count;
      }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

double mistaken_friction(std::span<const ContactTerm> solved, std::span<const ContactTerm> lagged, const Points& x0,
                         const Points& x, double slip_width) {
  std::vector<double> over(x.rows(), 0.0);
  double wrong = 0, allowed = 0;
  for (std::size_t k = 0; k < solved.size(); ++k) {
    const double slip = contact_slip(solved[k], x0, x).norm();
    const double used = friction_force(solved[k], Vec3(slip, 0, 0), slip_width).factor * slip;
    const double bound = lagged[k].friction * lagged[k].normal_force;
    allowed += bound;
    if (slip >= slip_width) wrong += std::abs(used - bound);
    for (int i = 0; i < 4 && slip < slip_width; ++i)
      if (solved[k].nodes[i] >= 0) over[solved[k].nodes[i]] += std::abs(solved[k].weights[i]) * (used - bound);
  }
  for (const double excess : over) wrong += std::max(0.0, excess);
  return wrong > 0 ? wrong / allowed : 0;
}

void relinearise(const ContactMotion& motion, Contacts& contacts) {
  const Points& nodes1 = motion.nodes1;
  for (std::size_t k = 0; k < contacts.terms.size(); ++k) {
    const NodePair& pair = contacts.pairs[k];
    const ContactTerm& old = contacts.terms[k];
    const Closest now = closest(pair, nodes1);
    Vec3 between = Vec3::Zero();
    for (int i = 0; i < 4; ++i) between += now.weights[i] * row(nodes1, pair.nodes[i]);
    if (between.dot(old.normal) <= motion.options.same_side * between.norm()) continue;
    ContactTerm term;
    term.normal = contact_normal(motion.world, pair, now.weights, between, nodes1);
    term.target = old.target;
    term.softness = old.softness;
    term.sink = old.sink;
    if (!linearise(motion, pair, now.weights, term)) continue;
    term.stiffness = old.stiffness;
    term.stiffest = old.stiffest;
    term.normal_force = old.normal_force;
    contacts.terms[k] = term;
  }
}

void set_load_stiffness(std::vector<ContactTerm>& terms, const Eigen::VectorXd& inverse_mass, const Points& forces,
                        const ContactTermOptions& options) {
  std::vector<double> borne(forces.rows(), 0.0), held(borne);  // number of terms of each vertex; sum of their weights
  for (const ContactTerm& term : terms)
    for (int i = 0; i < 4; ++i)
      if (term.nodes[i] >= 0) {
        borne[term.nodes[i]] += term.weights[i] * term.weights[i];
        held[term.nodes[i]] += std::abs(term.weights[i]);
      }
  for (ContactTerm& term : terms) {
    double approach = 0, alone = 0, shared = 0, together = 0;  // acceleration; sums of squared weights
    for (int i = 0; i < 4; ++i) {
      const int node = term.nodes[i];
      if (node < 0) continue;
      const double square = term.weights[i] * term.weights[i];
      approach -= term.weights[i] * inverse_mass[node] * term.normal.dot(row(forces, node));
      alone += square;
      shared += square * borne[node];
      together += std::abs(term.weights[i]) * held[node];
    }
    const double load = approach / compliance(term, inverse_mass);
    term.stiffness = std::max(term.stiffness, load * std::sqrt(alone / shared) / term.sink);
    term.stiffest = options.max_stiffening * term.stiffness;
    term.normal_force = std::max(0.0, load * alone / together);
  }
}

void raise_stiffness(std::vector<ContactTerm>& terms, const Points& x) {
  for (ContactTerm& term : terms) {
    const double sunk = term.target - contact_gap(term, x) - 0.5 * term.softness;
    if (sunk > term.sink) term.stiffness = std::min(term.stiffness * sunk / term.sink, term.stiffest);
  }
}

void apply_static_friction(std::span<const ContactTerm> terms, const Eigen::VectorXd& inverse_mass, const Points& x0,
                           double h, double slip_width, Points& x, const ContactTermOptions& options, Points* forces) {
  std::vector<double> budget(terms.size(), 0.0);  // tangential impulse times h still allowed [kg m]
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const Vec3 slip = contact_slip(terms[k], x0, x);
    if (slip.norm() > slip_width) continue;  // it slides: the solve has used the whole bound
    const double used = friction_force(terms[k], slip, slip_width).factor * slip.norm();
    budget[k] = std::max(0.0, terms[k].friction * terms[k].normal_force - used) * h * h;
  }
  for (int sweep = 0; sweep < options.static_friction_sweeps; ++sweep)
    for (std::size_t k = 0; k < terms.size(); ++k) {
      if (budget[k] <= 0) continue;
      const ContactTerm& term = terms[k];
      const Vec3 slip = contact_slip(term, x0, x);
      const double length = slip.norm();
      if (length == 0) continue;
      const double impulse = std::min(budget[k], length / compliance(term, inverse_mass));
      budget[k] -= impulse;
      for (int i = 0; i < 4; ++i)
        if (term.nodes[i] >= 0) {
          x.row(term.nodes[i]) -= term.weights[i] * inverse_mass[term.nodes[i]] * impulse / length * slip.transpose();
          if (forces) forces->row(term.nodes[i]) -= term.weights[i] * impulse / (h * h * length) * slip.transpose();
        }
    }
}

}  // namespace selvedge

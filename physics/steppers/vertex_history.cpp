#include "physics/steppers/vertex_history.hpp"

#include <cmath>
#include <numeric>

#include "physics/energies/joints.hpp"

namespace selvedge {
namespace {

// A part in a substep.
struct PartState {
  bool near = false;      // a contact has a vertex of it
  bool held = false;      // by pins, or by contact with an obstacle
  bool was_near = false;  // in the last substep; or there is no history
};

// The weights of a pair of cloth with cloth add up to 0: if both move alike, their gap does not change.
bool of_obstacle(const ContactTerm& term) {
  return std::abs(std::accumulate(term.weights.begin(), term.weights.end(), 0.0)) > 0.5;
}

std::vector<PartState> part_states(const PinnedParts& parts, const StepHistory& history, bool usable,
                                   const Contacts& contacts) {
  std::vector<PartState> states(parts.pinned.size());
  for (std::size_t p = 0; p < states.size(); ++p) states[p] = {false, parts.pinned[p] != 0, !usable};
  for (const ContactTerm& term : contacts.terms)
    for (const int node : term.nodes) {
      if (node < 0) continue;
      PartState& part = states[parts.part[node]];
      part.near = true;
      part.held = part.held || of_obstacle(term);
    }
  for (std::size_t i = 0; i < history.contact.size(); ++i)
    if (history.contact[i] != VertexContact::none) states[parts.part[i]].was_near = true;
  return states;
}

VertexContact last_contact(const StepHistory& history, std::size_t vertex) {
  return history.contact.empty() ? VertexContact::none : history.contact[vertex];
}

VertexRule rule_of(bool near, bool jumped) {
  if (!jumped) return VertexRule::bdf2;
  return near ? VertexRule::euler : VertexRule::start;
}

}  // namespace

PinnedParts::PinnedParts(const Scene& scene) : part(joined_components(scene)), pinned(scene.surface.component_count) {
  for (const int pin : scene.pins) pinned[part[pin]] = 1;
}

void mark_near(const StepHistory& history, const Contacts& contacts, std::vector<VertexContact>& contact) {
  for (const ContactTerm& term : contacts.terms)
    for (const int node : term.nodes)
      if (node >= 0)
        contact[node] = last_contact(history, node) == VertexContact::none ? VertexContact::begun : VertexContact::near;
}

void mark_moved(const Points& wanted, const Points& nodes, std::vector<VertexContact>& contact) {
  for (std::size_t k = 0; k < contact.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (nodes.row(i) != wanted.row(i)) contact[k] = VertexContact::begun;
  }
}

bool pins_jump(const Scene& scene, const StepHistory& history, const Points& nodes0, const Points& pins, double most) {
  if (!(history.h > 0)) return false;
  for (std::size_t k = 0; k < scene.pins.size(); ++k) {
    const int pin = scene.pins[k];
    const Vec3 now = row(pins, static_cast<int>(k)) - row(nodes0, pin), before = row(nodes0, pin) - row(history.x, pin);
    if ((now - before).norm() > most) return true;
  }
  return false;
}

std::vector<VertexRule> vertex_rules(const PinnedParts& parts, const StepHistory& history, double h,
                                     const Contacts& contacts, const std::vector<VertexContact>& contact) {
  const bool usable = history.h == h;
  const std::vector<PartState> states = part_states(parts, history, usable, contacts);
  std::vector<VertexRule> rules(contact.size());
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const PartState& part = states[parts.part[i]];
    const bool begins = contact[i] == VertexContact::begun || last_contact(history, i) == VertexContact::begun;
    rules[i] = part.held ? rule_of(contact[i] != VertexContact::none, !usable || begins)
                         : rule_of(part.near, part.near || part.was_near);
  }
  return rules;
}

Points end_velocities(const VertexStarts& starts, const Points& solved, const Points& x1, double h) {
  Points v = (x1 - solved) / h;
  for (Eigen::Index i = 0; i < v.rows(); ++i)
    v.row(i) += (solved.row(i) - starts.x.row(i)) / starts.position_h[static_cast<std::size_t>(i)];
  return v;
}

}  // namespace selvedge

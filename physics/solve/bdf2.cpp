#include "physics/solve/bdf2.hpp"

#include <algorithm>
#include <cassert>

namespace selvedge {
namespace {

constexpr const char *length_block = "bdf2.h", *position_block = "bdf2.x", *velocity_block = "bdf2.v",
                     *contact_block = "bdf2.contact";

}  // namespace

bool StepHistory::free() const {
  return h > 0 && std::ranges::all_of(contact, [](VertexContact c) { return c == VertexContact::none; });
}

StepHistory step_history(const State& state) {
  const MemoryRows* h = find_rows(state.memory, length_block, 1);
  const MemoryRows* x = find_rows(state.memory, position_block, state.x.rows());
  const MemoryRows* v = find_rows(state.memory, velocity_block, state.x.rows());
  if (!h || !x || !v) return {};
  StepHistory history{(*h)(0, 0), *x, *v, {}};
  if (const MemoryRows* contact = find_rows(state.memory, contact_block, state.x.rows()))
    for (const double c : contact->reshaped()) history.contact.push_back(static_cast<VertexContact>(c));
  return history;
}

Memory blocks_of(const StepHistory& history) {
  if (!(history.h > 0)) return {};
  Memory memory{{length_block, MemoryRows::Constant(1, 1, history.h), RowsOf::none},
                {position_block, history.x, RowsOf::vertices, true},
                {velocity_block, history.v, RowsOf::vertices}};
  if (history.free()) return memory;
  MemoryRows contact(static_cast<Eigen::Index>(history.contact.size()), 1);
  std::ranges::transform(history.contact, contact.data(), [](VertexContact c) { return static_cast<double>(c); });
  memory.push_back({contact_block, std::move(contact), RowsOf::vertices});
  return memory;
}

void forget_history(State& state) { replace_blocks("bdf2", {}, state.memory); }

// Written with differences, so that cloth at rest gives exactly its own positions.
StepStart bdf2_start(const StepHistory& history, const Points& x0, const Points& v0) {
  assert(history.h > 0 && history.x.rows() == x0.rows() && history.v.rows() == v0.rows());
  return {2 * history.h / 3, x0 + (x0 - history.x) / 3, v0 + (v0 - history.v) / 3};
}

VertexStarts starts_of(std::span<const VertexRule> rules, const StepHistory& history, const Points& x0,
                       const Points& v0, double h) {
  assert(static_cast<Eigen::Index>(rules.size()) == x0.rows());
  VertexStarts starts{std::vector<double>(rules.size(), h), std::vector<double>(rules.size(), h), x0, v0};
  for (std::size_t k = 0; k < rules.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (rules[k] == VertexRule::start) {
      starts.position_h[k] = h / 2;
      starts.x.row(i) += h / 2 * v0.row(i);
    } else if (rules[k] == VertexRule::bdf2) {
      starts.position_h[k] = starts.velocity_h[k] = 2 * h / 3;
      starts.x.row(i) += (x0.row(i) - history.x.row(i)) / 3;
      starts.v.row(i) += (v0.row(i) - history.v.row(i)) / 3;
    }
  }
  return starts;
}

}  // namespace selvedge

#include "physics/solve/bdf2.hpp"

#include <cassert>

namespace selvedge {
namespace {

constexpr const char *length_block = "bdf2.h", *position_block = "bdf2.x", *velocity_block = "bdf2.v";

}  // namespace

StepHistory step_history(const State& state) {
  const MemoryRows* h = find_rows(state.memory, length_block, 1);
  const MemoryRows* x = find_rows(state.memory, position_block, state.x.rows());
  const MemoryRows* v = find_rows(state.memory, velocity_block, state.x.rows());
  if (!h || !x || !v) return {};
  return {(*h)(0, 0), *x, *v};
}

Memory blocks_of(const StepHistory& history) {
  if (!(history.h > 0)) return {};
  return {{length_block, MemoryRows::Constant(1, 1, history.h), RowsOf::none},
          {position_block, history.x, RowsOf::vertices, true},
          {velocity_block, history.v, RowsOf::vertices}};
}

void forget_history(State& state) { replace_blocks("bdf2", {}, state.memory); }

// Written with differences, so that cloth at rest gives exactly its own positions.
StepStart bdf2_start(const StepHistory& history, const Points& x0, const Points& v0) {
  assert(history.h > 0 && history.x.rows() == x0.rows() && history.v.rows() == v0.rows());
  return {2 * history.h / 3, x0 + (x0 - history.x) / 3, v0 + (v0 - history.v) / 3};
}

}  // namespace selvedge

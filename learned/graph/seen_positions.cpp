#include "learned/graph/seen_positions.hpp"

namespace selvedge {

void move_pinned(const RestGraph& rest, const Points& target, Points& x, Points& previous) {
  for (const int v : rest.pinned) {
    previous.row(v) = x.row(v);
    x.row(v) = target.row(v);
  }
}

SeenPositions seen_positions(const RestGraph& rest, const GraphState& state, const FeatureOptions& options) {
  SeenPositions seen{state.x, state.previous, state.x};
  if (options.pinned == PinnedForm::moved) {
    move_pinned(rest, state.target, seen.x, seen.previous);
    seen.mesh = seen.x;
  } else {
    for (const int v : rest.pinned) seen.mesh.row(v) = state.target.row(v);
  }
  return seen;
}

Points inertial_guess(const RestGraph& rest, const GraphState& state, const SeenPositions& seen,
                      const FeatureOptions& options) {
  Points guess =
      seen.x + (options.cloth_velocity == ClothVelocity::carried ? state.velocity : Points(seen.x - seen.previous));
  for (const int v : rest.pinned) guess.row(v) = state.target.row(v);
  return guess;
}

Points guess_of(const RestGraph& rest, const GraphState& state, const SeenPositions& seen,
                const FeatureOptions& options) {
  return state.guess.rows() > 0 ? state.guess : inertial_guess(rest, state, seen, options);
}

}  // namespace selvedge

#include "learned/graph/seen_positions.hpp"

namespace selvedge {

SeenPositions seen_positions(const RestGraph& rest, const GraphState& state, const FeatureOptions& options) {
  SeenPositions seen{state.x, state.previous, state.x};
  for (const int v : rest.pinned) seen.mesh.row(v) = state.target.row(v);
  if (options.pinned == PinnedForm::moved) {
    for (const int v : rest.pinned) seen.previous.row(v) = state.x.row(v);
    seen.x = seen.mesh;
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

#include "learned/graph/integration.hpp"

#include <algorithm>
#include <utility>

#include "collision/geometry/error.hpp"
#include "learned/graph/nearest_faces.hpp"

namespace selvedge {
namespace {

// The rows seen from the frames of their vertices.
void turn_back(const GraphState& state, const FeatureOptions& options, Points& rows) {
  if (options.base != OutputBase::carried) return;
  for (std::size_t v = 0; v < state.frames.size(); ++v) {
    const auto i = static_cast<Eigen::Index>(v);
    rows.row(i) = (rows.row(i) * state.frames[v]).eval();
  }
}

// The guess, and beside it the output in the frames of the vertices.
NextCloth beside_guess(const GraphState& state, const SeenPositions& seen, Points guess, const Statistics& output,
                       const FeatureRows& decoded) {
  NextCloth next{std::move(guess), {}};
  for (Eigen::Index v = 0; v < decoded.rows(); ++v) {
    Vec3 a;
    for (int k = 0; k < 3; ++k)
      a[k] = static_cast<double>(decoded(v, k)) * static_cast<double>(output.deviation[static_cast<std::size_t>(k)]);
    if (!state.frames.empty()) a = state.frames[static_cast<std::size_t>(v)] * a;
    next.x.row(v) += a.transpose();
  }
  next.velocity = next.x - seen.x;
  return next;
}

void set_pinned(const RestGraph& rest, const GraphState& state, const SeenPositions& seen, NextCloth& next) {
  for (const int v : rest.pinned) {
    next.velocity.row(v) = state.target.row(v) - seen.x.row(v);
    next.x.row(v) = state.target.row(v);
  }
}

}  // namespace

NextCloth integrate(const RestGraph& rest, const GraphState& state, const FeatureOptions& options,
                    const Statistics& output, const FeatureRows& decoded) {
  if (decoded.rows() != state.x.rows() || decoded.cols() != 3 || output.mean.size() != 3 ||
      output.deviation.size() != 3)
    throw Error("the output of a network has three columns and a row for each cloth vertex",
                "integration of a learned step", "");
  if (!state.frames.empty() && std::ssize(state.frames) != state.x.rows())
    throw Error("a state has a frame for each cloth vertex, or none", "integration of a learned step", "");
  const SeenPositions seen = seen_positions(rest, state, options);
  if (options.base == OutputBase::carried) {
    NextCloth next = beside_guess(state, seen, guess_of(rest, state, seen, options), output, decoded);
    set_pinned(rest, state, seen, next);
    return next;
  }
  const bool carried = options.cloth_velocity == ClothVelocity::carried;
  NextCloth next{seen.x, carried ? state.velocity : Points(seen.x - seen.previous)};
  if (state.guess.rows() > 0) next.velocity = state.guess - seen.x;
  for (Eigen::Index v = 0; v < decoded.rows(); ++v)
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto column = static_cast<std::size_t>(k);
      next.velocity(v, k) += static_cast<double>(decoded(v, k)) * static_cast<double>(output.deviation[column]) +
                             static_cast<double>(output.mean[column]);
    }
  next.x += next.velocity;
  set_pinned(rest, state, seen, next);
  return next;
}

Points by_acceleration(const RestGraph& rest, const GraphState& state, const FeatureOptions& options, Points by_x) {
  for (const int pin : rest.pinned) by_x.row(pin).setZero();
  turn_back(state, options, by_x);
  return by_x;
}

FeatureRows target_accelerations(const RestGraph& rest, const GraphState& state, const FeatureOptions& options) {
  const SeenPositions seen = seen_positions(rest, state, options);
  Points accelerations = state.target - 2 * seen.x + seen.previous;
  turn_back(state, options, accelerations);
  return accelerations.cast<float>();
}

int push_out(const Surface& body, const Points& body_x, double margin, Points& x) {
  NearestFaces search;
  const std::vector<int>& nearest = nearest_centroids(body, body_x, {}, x, search);
  int moved = 0;
  for (int v = 0; v < static_cast<int>(x.rows()); ++v) {
    const int face = nearest[static_cast<std::size_t>(v)];
    if (face < 0) continue;
    const CentroidPlane plane = centroid_plane(body, body_x, face);
    const double short_of = (row(x, v) - plane.centroid).dot(plane.normal) - margin;
    x.row(v) -= (std::min(short_of, 0.0) * plane.normal).transpose();
    moved += short_of < 0;
  }
  return moved;
}

}  // namespace selvedge

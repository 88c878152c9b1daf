#include "learned/graph/integration.hpp"

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "learned/graph/nearest_faces.hpp"

namespace selvedge {

NextCloth integrate(const RestGraph& rest, const GraphState& state, const FeatureOptions& options,
                    const Statistics& output, const FeatureRows& decoded) {
  if (decoded.rows() != state.x.rows() || decoded.cols() != 3 || output.mean.size() != 3 ||
      output.deviation.size() != 3)
    throw Error("the output of a network has three columns and a row for each cloth vertex",
                "integration of a learned step", "");
  const SeenPositions seen = seen_positions(rest, state, options);
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
  for (const int v : rest.pinned) {
    next.velocity.row(v) = state.target.row(v) - seen.x.row(v);
    next.x.row(v) = state.target.row(v);
  }
  return next;
}

FeatureRows target_accelerations(const RestGraph& rest, const GraphState& state, const FeatureOptions& options) {
  const SeenPositions seen = seen_positions(rest, state, options);
  return (state.target - 2 * seen.x + seen.previous).cast<float>();
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

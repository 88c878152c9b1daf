#include "learned/graph/integration.hpp"

#include <algorithm>
#include <limits>

#include "collision/geometry/error.hpp"
#include "learned/graph/nearest_item.hpp"

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
  const auto faces = static_cast<int>(body.triangles.rows());
  Points centroids(faces, 3);
  for (int f = 0; f < faces; ++f)
    centroids.row(f) =
        (body_x.row(body.triangles(f, 0)) + body_x.row(body.triangles(f, 1)) + body_x.row(body.triangles(f, 2))) / 3;
  std::vector<Box> boxes;
  vertex_boxes(centroids, centroids, 0, boxes);
  const Bvh tree = build_bvh(boxes);
  const int count = static_cast<int>(x.rows());
  int moved = 0;
#pragma omp parallel for schedule(static, 64) reduction(+ : moved)
  for (int v = 0; v < count; ++v) {
    const Vec3 p = row(x, v);
    NearGroup alone;
    alone.add(p, {std::numeric_limits<double>::infinity(), -1});
    find_nearest(tree, alone, [&](const Vec3& q, int f) { return (row(centroids, f) - q).squaredNorm(); });
    const int face = alone.best[0].item;
    if (face < 0) continue;
    const int* corner = body.triangles.data() + 3 * face;
    const Vec3 a = row(body_x, corner[0]);
    const Vec3 normal = (row(body_x, corner[1]) - a).cross(row(body_x, corner[2]) - a).normalized();
    const double short_of = (p - row(centroids, face)).dot(normal) - margin;
    x.row(v) = (p - std::min(short_of, 0.0) * normal).transpose();
    moved += short_of < 0;
  }
  return moved;
}

}  // namespace selvedge

#include <cmath>

#include "collision/geometry/distance.hpp"
#include "learned/graph/nearest_faces.hpp"
#include "learned/graph/node_columns.hpp"
#include "learned/graph/node_features.hpp"

namespace selvedge {
namespace {

// A face of the body in one pose, with the point that a cloth vertex is matched with.
struct FacePose : CentroidPlane {
  Vec3 point;
};

FacePose face_pose(const Surface& body, const Points& x, int face, const Vec3& weights) {
  const int* v = body.triangles.data() + 3 * face;
  return {centroid_plane(body, x, face),
          weights[0] * row(x, v[0]) + weights[1] * row(x, v[1]) + weights[2] * row(x, v[2])};
}

void fill_body_columns(const GraphScene& scene, const GraphState& state, const SeenPositions& seen, const Points& guess,
                       const BodyPair& pair, int first, FeatureRows& nodes) {
  const Vec3 x = row(seen.x, pair.cloth);
  const int* v = scene.body.triangles.data() + 3 * pair.face;
  const Closest nearest = point_triangle(x, row(state.body, v[0]), row(state.body, v[1]), row(state.body, v[2]));
  const Vec3 weights = -nearest.weights.tail<3>();
  const FacePose now = face_pose(scene.body, state.body, pair.face, weights);
  const FacePose next = face_pose(scene.body, state.body_target, pair.face, weights);
  auto features = nodes.row(pair.cloth);
  features.segment<3>(first) = (x - now.point).transpose().cast<float>();
  features.segment<3>(first + 3) = (x - next.point).transpose().cast<float>();
  features.segment<3>(first + 6) = next.normal.transpose().cast<float>();
  features(first + 9) = static_cast<float>((x - now.centroid).dot(now.normal));
  features(first + 10) = static_cast<float>((row(guess, pair.cloth) - next.centroid).dot(next.normal));
  features.segment<3>(first + 11) = (next.point - now.point).transpose().cast<float>();
}

// Shortens long vectors, so that a strong contact force does not dominate the feature.
Eigen::RowVector3f compressed(const Vec3& force) {
  constexpr double unit = 1e-3;  // [m]
  const double length = force.norm();
  return (length > 0 ? Vec3(force * (std::log1p(length / unit) / length)) : Vec3(Vec3::Zero()))
      .transpose()
      .cast<float>();
}

// guess - x, then the elastic and the inertial forces over the mass, times dt^2, then the motion of the skinned target
// and the offset from it [m].
void fill_guess_columns(const GraphScene& scene, const GraphState& state, const SeenPositions& seen,
                        const Points& guess, const Points& inertial, int first, FeatureRows& nodes) {
  const double dt2 = state.timestep * state.timestep;
#pragma omp parallel for schedule(static, 256)
  for (int v = 0; v < scene.cloth.vertex_count; ++v) {
    auto features = nodes.row(v);
    features.segment<3>(first) = (guess.row(v) - seen.x.row(v)).cast<float>();
    if (state.worn_motion.rows() > 0) features.segment<3>(first + 9) = state.worn_motion.row(v).cast<float>();
    if (state.worn_offset.rows() > 0) features.segment<3>(first + 12) = state.worn_offset.row(v).cast<float>();
    if (scene.types[static_cast<std::size_t>(v)] == pinned_vertex) continue;
    if (state.elastic.rows() > 0) features.segment<3>(first + 3) = compressed(row(state.elastic, v));
    Vec3 left = row(inertial, v) - row(guess, v);
    if (state.acceleration.rows() > 0) left += dt2 * row(state.acceleration, v);
    features.segment<3>(first + 6) = compressed(left);
  }
}

}  // namespace

void fill_objective_columns(const GraphScene& scene, const GraphState& state, const SeenPositions& seen,
                            const Points& guess, const Points& inertial, const FeatureOptions& options,
                            const std::vector<BodyPair>& pairs, Graph& graph) {
  const NodeColumns at(options);
  const int cloth = scene.cloth.vertex_count;
  int column = at.objective, flag = at.flags;
  if (options.pinned_flag) {
    for (int v = 0; v < cloth; ++v)
      graph.nodes(v, flag) = scene.types[static_cast<std::size_t>(v)] == pinned_vertex ? 1.f : 0.f;
    ++flag;
  }
  if (options.body_inputs) {
    for (const BodyPair& pair : pairs) {
      if (pair.face < 0) continue;
      fill_body_columns(scene, state, seen, guess, pair, column, graph.nodes);
      graph.nodes(pair.cloth, flag) = 1.f;
    }
    column += 14;
    ++flag;
  }
  if (options.force_inputs) {
    for (int v = 0; v < cloth && state.force.rows() > 0; ++v)
      graph.nodes.row(v).segment<3>(column) = compressed(row(state.force, v));
    column += 3;
  }
  if (options.pass_inputs) {
    graph.nodes.topRows(cloth).middleCols<3>(column) = (guess - inertial).cast<float>();
    graph.nodes.topRows(cloth).col(flag).setConstant(static_cast<float>(state.pass));
    column += 3;
  }
  if (options.guess_inputs) fill_guess_columns(scene, state, seen, guess, inertial, column, graph.nodes);
}

}  // namespace selvedge

#include "learned/graph/edge_features.hpp"

#include <algorithm>

#include "learned/graph/embedding.hpp"

namespace selvedge {
namespace {

// Writes a vector and its norm into four columns.
template <class Row>
void put_vector(Row&& features, int first, const Vec3& vector) {
  features.template segment<3>(first) = vector.transpose().cast<float>();
  features(first + 3) = static_cast<float>(vector.norm());
}

float time_value(const GraphState& state, const FeatureOptions& options) {
  if (options.time == TimeFeature::timestep) return static_cast<float>(state.timestep);
  return state.is_init ? 1.0f : 0.0f;
}

// The strain is 0 where the rest length is zero.
float strain_of(double length, double rest) { return rest > 0 ? static_cast<float>((length - rest) / rest) : 0.f; }

int body_node(const std::vector<int>& body_vertices, int vertex, int cloth_nodes) {
  const auto at = std::lower_bound(body_vertices.begin(), body_vertices.end(), vertex);
  return cloth_nodes + static_cast<int>(at - body_vertices.begin());
}

// The row of an edge from cloth to body: now, next, and velocity where the options have it.
void put_body_row(const BodyPair& pair, const GraphState& state, const SeenPositions& seen,
                  const FeatureOptions& options, FeatureRows& rows, Eigen::Index e) {
  const Vec3 x = row(seen.x, pair.cloth), body = row(state.body, pair.vertex),
             next = row(state.body_target, pair.vertex);
  put_vector(rows.row(e), options.next_body_first ? 4 : 0, x - body);
  put_vector(rows.row(e), options.next_body_first ? 0 : 4, x - next);
  if (options.body_edge_velocity) put_vector(rows.row(e), 8, row(state.velocity, pair.cloth) - (next - body));
  rows(e, rows.cols() - 1) = time_value(state, options);
}

void negate_vectors(FeatureRows& rows, Eigen::Index e) {
  for (int first = 0; first + 4 < rows.cols(); first += 4) rows.row(e).segment<3>(first) *= -1;
}

}  // namespace

void fill_mesh_edges(const RestEdges& rest, const GraphState& state, const SeenPositions& seen, const Points& guess,
                     const FeatureOptions& options, EdgeSet& set) {
  set.senders = rest.senders;
  set.receivers = rest.receivers;
  const auto count = static_cast<Eigen::Index>(rest.senders.size());
  const auto width = rest.rest.cols();
  const float time = time_value(state, options);
  set.features.resize(count, mesh_edge_widths(options).all);
#pragma omp parallel for schedule(static, 512)
  for (Eigen::Index e = 0; e < count; ++e) {
    auto features = set.features.row(e);
    const int s = rest.senders[static_cast<std::size_t>(e)], r = rest.receivers[static_cast<std::size_t>(e)];
    const Vec3 relative = row(seen.mesh, s) - row(seen.mesh, r);
    put_vector(features, 0, relative);
    for (Eigen::Index k = 0; k < width; ++k) features(4 + k) = rest.rest(e, k);
    Eigen::Index next = 4 + width;
    if (options.strain_inputs) {
      const auto length = static_cast<double>(rest.rest(e, width - 1));
      features(next++) = strain_of(relative.norm(), length);
      features(next++) = strain_of((row(guess, s) - row(guess, r)).norm(), length);
    }
    if (!options.edge_context) continue;
    features(next) = time;
    features.segment<3>(next + 1) = rest.materials.row(e);
  }
}

void fill_body_edges(const std::vector<BodyPair>& pairs, const std::vector<int>& body_vertices, const GraphState& state,
                     const SeenPositions& seen, const FeatureOptions& options, EdgeSet& set) {
  const auto count = static_cast<int>(pairs.size());
  const std::size_t half = pairs.size();
  const int cloth_nodes = static_cast<int>(state.x.rows());
  set.senders.resize(2 * half);
  set.receivers.resize(2 * half);
  set.features.resize(2 * count, body_edge_widths(options).all);
#pragma omp parallel for schedule(static, 256)
  for (int e = 0; e < count; ++e) {
    const BodyPair& pair = pairs[static_cast<std::size_t>(e)];
    const std::size_t there = static_cast<std::size_t>(e), back = there + half;
    set.senders[there] = set.receivers[back] = pair.cloth;
    set.receivers[there] = set.senders[back] = body_node(body_vertices, pair.vertex, cloth_nodes);
    put_body_row(pair, state, seen, options, set.features, e);
    set.features.row(count + e) = set.features.row(e);
    negate_vectors(set.features, count + e);
  }
}

void fill_cloth_edges(const std::vector<ClothPair>& pairs, const GraphScene& scene, const GraphState& state,
                      const SeenPositions& seen, const FeatureOptions& options, const FeatureTables& tables,
                      EdgeSet& set) {
  const bool dt = options.time == TimeFeature::timestep;
  const int label = embedding_columns(options).label, time = dt ? 12 : 12 + options.label_columns,
            materials = 13 + options.label_columns;
  const std::size_t count = pairs.size();
  set.senders.resize(count);
  set.receivers.resize(count);
  set.labels.resize(count);
  set.features.resize(static_cast<Eigen::Index>(count), cloth_edge_widths(options).all);
  for (std::size_t e = 0; e < count; ++e) {
    const int s = set.senders[e] = pairs[e].vertex, r = set.receivers[e] = pairs[e].nearest;
    set.labels[e] = pairs[e].label;
    auto features = set.features.row(static_cast<Eigen::Index>(e));
    put_vector(features, 0, row(seen.x, s) - row(seen.x, r));
    put_vector(features, 4, row(seen.previous, s) - row(seen.previous, r));
    put_vector(features, 8, row(state.velocity, s) - row(state.velocity, r));
    features(time) = time_value(state, options);
    features.segment<3>(materials) = 0.5f * (scene.materials.row(s) + scene.materials.row(r));
  }
  embed(tables.edge_type, set.labels, label, options.label_columns, set.features);
}

}  // namespace selvedge

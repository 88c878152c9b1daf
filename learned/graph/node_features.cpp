#include "learned/graph/node_features.hpp"

#include "learned/graph/area_normal.hpp"
#include "learned/graph/embedding.hpp"
#include "learned/graph/node_columns.hpp"

namespace selvedge {
namespace {

// The unit vector along the area-weighted normals of the faces round a vertex; zero where there is none.
Eigen::RowVector3f vertex_normal(const Surface& surface, const Points& x, int vertex) {
  const Vec3 sum = area_normal(surface, x, vertex);
  const double length = sum.norm();
  return (length > 0 ? Vec3(sum / length) : Vec3(Vec3::Zero())).transpose().cast<float>();
}

void fill_cloth(const GraphScene& scene, const RestGraph& rest, const GraphState& state, const SeenPositions& seen,
                const FeatureOptions& options, const NodeColumns& at, FeatureRows& rows) {
  const bool carried = options.cloth_velocity == ClothVelocity::carried;
#pragma omp parallel for schedule(static, 256)
  for (int v = 0; v < scene.cloth.vertex_count; ++v) {
    const Eigen::RowVector3d velocity =
        carried ? Eigen::RowVector3d(state.velocity.row(v)) : Eigen::RowVector3d(seen.x.row(v) - seen.previous.row(v));
    rows.row(v).head<3>() = velocity.cast<float>();
    rows.row(v).segment<3>(at.normal) = vertex_normal(scene.cloth, seen.x, v);
    rows(v, at.mass) = rest.mass[static_cast<std::size_t>(v)];
    rows.row(v).segment<3>(at.materials) = scene.materials.row(v);
  }
}

void fill_body(const GraphScene& scene, const GraphState& state, const FeatureOptions& options, const NodeColumns& at,
               const std::vector<int>& vertices, FeatureRows& rows) {
  const bool next = options.body_velocity == BodyVelocity::next;
  const Points &to = next ? state.body_target : state.body, &from = next ? state.body : state.body_previous;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    auto features = rows.row(scene.cloth.vertex_count + static_cast<Eigen::Index>(i));
    features.head<3>() = (to.row(vertices[i]) - from.row(vertices[i])).cast<float>();
    features.segment<3>(at.normal) = vertex_normal(scene.body, state.body, vertices[i]);
    features(at.mass) = -1;
    features.segment<3>(at.materials).setConstant(-1);
  }
}

}  // namespace

void fill_node_rows(const GraphScene& scene, const RestGraph& rest, const GraphState& state, const SeenPositions& seen,
                    const FeatureOptions& options, const FeatureTables& tables, Graph& graph) {
  graph.cloth_nodes = scene.cloth.vertex_count;
  graph.node_types = scene.types;
  graph.node_levels = rest.vertex_levels;
  for (const int v : graph.body_vertices) graph.node_types.push_back(scene.body_types[static_cast<std::size_t>(v)]);
  graph.node_levels.resize(graph.node_types.size(), 0);
  const NodeColumns at(options);
  graph.nodes.resize(static_cast<Eigen::Index>(graph.node_types.size()), node_widths(options).all);
  graph.nodes.middleCols(at.objective, objective_columns(options)).setZero();
  graph.nodes.rightCols(graph.nodes.cols() - at.flags).setZero();
  if (options.acceleration_inputs && state.acceleration.rows() > 0)
    graph.nodes.block(0, at.objective + objective_columns(options) - 3, graph.cloth_nodes, 3) =
        state.acceleration.cast<float>();
  fill_cloth(scene, rest, state, seen, options, at, graph.nodes);
  fill_body(scene, state, options, at, graph.body_vertices, graph.nodes);
  graph.nodes.col(at.time).setConstant(options.time == TimeFeature::timestep ? static_cast<float>(state.timestep)
                                                                             : (state.is_init ? 1.0f : 0.0f));
  embed(tables.node_type, graph.node_types, at.type, options.type_columns, graph.nodes);
  embed(tables.vertex_level, graph.node_levels, at.level, options.level_columns, graph.nodes);
}

}  // namespace selvedge

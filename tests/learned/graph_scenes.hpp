#pragma once

#include <random>

#include "learned/graph/make_graph.hpp"

// Scenes and tables for tests of graphs.
namespace selvedge::fake {

struct Mesh {
  Points x{0, 3};
  Triangles triangles{0, 3};
};

inline Surface surface_of(const Mesh& mesh) { return make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles); }

// n x m vertices in the plane y = 0, starting at the origin.
inline Mesh grid(int n, int m, double spacing = 0.02) {
  Mesh mesh{Points(n * m, 3), Triangles(2 * (n - 1) * (m - 1), 3)};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) mesh.x.row(i * m + j) << spacing * i, 0, spacing * j;
  int t = 0;
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < m; ++j) {
      const int a = i * m + j, b = a + 1, c = a + m, d = c + 1;
      mesh.triangles.row(t++) << a, b, c;
      mesh.triangles.row(t++) << b, d, c;
    }
  return mesh;
}

inline Mesh two_triangles() { return grid(2, 2); }

inline void add(Mesh& mesh, const Mesh& more, const Eigen::RowVector3d& by) {
  const auto vertices = mesh.x.rows(), triangles = mesh.triangles.rows();
  mesh.x.conservativeResize(vertices + more.x.rows(), 3);
  mesh.x.bottomRows(more.x.rows()) = more.x.rowwise() + by;
  mesh.triangles.conservativeResize(triangles + more.triangles.rows(), 3);
  mesh.triangles.bottomRows(more.triangles.rows()) = more.triangles.array() + static_cast<int>(vertices);
}

inline void jitter(Points& x, double by, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> some(-by, by);
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += some(random);
}

struct World {
  GraphScene scene;
  GraphState state;
};

// A cloth that moves a little, and a body at rest.
inline World world(const Mesh& cloth, const Mesh& body = {}) {
  World made;
  const auto count = static_cast<std::size_t>(cloth.x.rows());
  made.scene.cloth = surface_of(cloth);
  made.scene.rest = cloth.x;
  made.scene.mass.assign(count, 1e-4);
  made.scene.types.assign(count, free_vertex);
  made.scene.materials = FeatureRows::Constant(cloth.x.rows(), 3, 0.5f);
  made.scene.body = surface_of(body);
  made.scene.body_types.assign(static_cast<std::size_t>(body.x.rows()), body_vertex);
  made.state.x = made.state.target = cloth.x;
  made.state.velocity = Points::Constant(cloth.x.rows(), 3, 1e-3);
  made.state.previous = made.state.x - made.state.velocity;
  made.state.body = made.state.body_previous = made.state.body_target = body.x;
  return made;
}

inline Statistics plain_statistics(int columns) {
  const auto count = static_cast<std::size_t>(columns);
  return {std::vector<float>(count, 0.25f), std::vector<float>(count, 0.5f)};
}

inline FeatureTables tables(const FeatureOptions& options) {
  FeatureTables made;
  made.node = plain_statistics(node_widths(options).normalised);
  made.mesh_edge = made.coarse_edge = made.space_edge = plain_statistics(mesh_edge_widths(options).normalised);
  made.world_edge =
      plain_statistics((options.cloth_edges ? cloth_edge_widths(options) : body_edge_widths(options)).normalised);
  made.body_edge = plain_statistics(body_edge_widths(options).normalised);
  made.output = plain_statistics(3);
  made.node_type = FeatureRows::Constant(4, options.type_columns, 0.1f);
  made.vertex_level = FeatureRows::Constant(options.highest_level + 1, options.level_columns, 0.2f);
  made.edge_type = FeatureRows::Constant(2, options.label_columns, 0.3f);
  return made;
}

struct MadeGraph {
  Graph graph;
  GraphReport report;
};

// `kept` has search and memory of an earlier frame.
inline void make_again(const World& world, const FeatureOptions& options, GraphSearch& search, MadeGraph& kept) {
  make_graph(world.scene, make_rest_graph(world.scene, options), world.state, options, tables(options), search,
             kept.graph, kept.report);
}

inline MadeGraph made_graph(const World& world, const FeatureOptions& options) {
  GraphSearch search;
  MadeGraph made;
  make_again(world, options, search, made);
  return made;
}

inline bool same_graph(const Graph& a, const Graph& b) {
  const auto same = [](const FeatureRows& m, const FeatureRows& n) {
    return m.rows() == n.rows() && m.cols() == n.cols() && (m.array() == n.array()).all();
  };
  bool equal = same(a.nodes, b.nodes) && a.body_vertices == b.body_vertices && a.node_types == b.node_types &&
               a.node_levels == b.node_levels && a.edge_sets.size() == b.edge_sets.size();
  for (std::size_t i = 0; equal && i < a.edge_sets.size(); ++i) {
    const EdgeSet &s = a.edge_sets[i], &t = b.edge_sets[i];
    equal = s.key == t.key && s.senders == t.senders && s.receivers == t.receivers && s.labels == t.labels &&
            same(s.features, t.features);
  }
  return equal;
}

inline bool all_finite(const Graph& graph) {
  bool finite = graph.nodes.allFinite();
  for (const EdgeSet& set : graph.edge_sets) finite = finite && set.features.allFinite();
  return finite;
}

}  // namespace selvedge::fake

#pragma once

#include <random>
#include <vector>

#include "physics/scene/make_scene.hpp"

// Small cloths for the tests of physics.
namespace selvedge::meshes {

struct Mesh {
  Points points;
  Triangles triangles;
  std::vector<Vec2> flat;  // rest coordinates u, v of each vertex; empty: triangles are flattened one by one
};

enum class Pattern { one_diagonal, alternating, jittered };  // jittered: one_diagonal with inner vertices moved

// columns x rows cells over width (u) x height (v) in the plane y = 0 with the normal up: (u, v) is at (u, 0, -v).
// Vertex (i, j) is j * (columns + 1) + i. From a jitter of 0.25 of a cell on a triangle can lose its area.
inline Mesh grid(int columns, int rows, double width, double height, Pattern pattern = Pattern::one_diagonal,
                 double jitter = 0.2) {
  Mesh mesh;
  std::mt19937 random(7);
  const auto noise = [&random, jitter] { return jitter * (2.0 * static_cast<double>(random()) / 4294967295.0 - 1); };
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      Vec2 uv(width * i / columns, height * j / rows);
      const bool inner = i > 0 && j > 0 && i < columns && j < rows;
      if (pattern == Pattern::jittered && inner) {
        uv.x() += noise() * width / columns;
        uv.y() += noise() * height / rows;
      }
      mesh.flat.push_back(uv);
    }
  mesh.points.resize(static_cast<Eigen::Index>(mesh.flat.size()), 3);
  for (std::size_t v = 0; v < mesh.flat.size(); ++v)
    mesh.points.row(static_cast<Eigen::Index>(v)) << mesh.flat[v].x(), 0, -mesh.flat[v].y();
  mesh.triangles.resize(2 * columns * rows, 3);
  for (int j = 0, t = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i, t += 2) {
      const int a = j * (columns + 1) + i, b = a + 1, c = b + columns + 1, d = c - 1;
      if (pattern == Pattern::alternating && (i + j) % 2 == 1) {
        mesh.triangles.row(t) << a, b, d;
        mesh.triangles.row(t + 1) << b, c, d;
      } else {
        mesh.triangles.row(t) << a, b, c;
        mesh.triangles.row(t + 1) << a, c, d;
      }
    }
  return mesh;
}

// Appends a mesh as the scene's next cloth. The rest metric is mesh.flat, or else the triangles of mesh.points.
inline void add_cloth(Scene& scene, const Mesh& mesh, const Material& material) {
  std::vector<RestTriangle> metric;
  for (Eigen::Index t = 0; t < mesh.triangles.rows() && !mesh.flat.empty(); ++t) {
    RestTriangle& flat = metric.emplace_back();
    for (int k = 0; k < 3; ++k) flat.col(k) = mesh.flat[static_cast<std::size_t>(mesh.triangles(t, k))];
  }
  selvedge::add_cloth(scene, mesh.points, mesh.triangles, material, material.name, metric);
}

inline Scene make_scene(const Mesh& mesh, const Material& material = {}) {
  Scene scene;
  scene.rest_is_flat = !mesh.flat.empty();
  add_cloth(scene, mesh, material);
  return scene;
}

inline Scene make_scene(const Points& points, const Triangles& triangles, const Material& material = {}) {
  return make_scene(Mesh{points, triangles, {}}, material);
}

}  // namespace selvedge::meshes

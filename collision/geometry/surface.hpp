#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "collision/geometry/lists.hpp"
#include "collision/geometry/points.hpp"

namespace selvedge {

// Topology of a triangle surface; positions live outside. Built once, constant afterwards.
struct Surface {
  int vertex_count = 0;
  Triangles triangles;
  Edges edges;  // unique, sorted lexicographically
  std::vector<std::array<int, 2>>
      edge_triangles;             // the two triangles of an edge, -1 at a boundary; the first two where non-manifold
  Triangles triangle_edges;       // edge k of a triangle joins its corners k and (k + 1) % 3
  IndexLists vertex_triangles;    // the triangles round each vertex, ascending
  std::vector<int> vertex_owner;  // the lowest triangle that has the vertex, -1 for an isolated one
  std::vector<int> edge_owner;    // the lowest triangle that has the edge
  std::vector<int> component;     // connected component of each vertex (isolated vertices: their own)
  int component_count = 0;
  int nonmanifold_edges = 0;  // edges with more than two triangles
  int isolated_vertices = 0;

  std::span<const int> triangles_of(int vertex) const { return vertex_triangles.of(vertex); }

  // The other one of an edge's two triangles; -1 at a boundary.
  int across(int edge, int triangle) const {
    const auto [first, second] = edge_triangles[edge];
    return first == triangle ? second : first;
  }

  // Which corner of a triangle one of its vertices is, and which of its edges an edge is.
  int corner_of(int triangle, int vertex) const {
    return triangles(triangle, 0) == vertex ? 0 : triangles(triangle, 1) == vertex ? 1 : 2;
  }
  int side_of(int triangle, int edge) const {
    return triangle_edges(triangle, 0) == edge ? 0 : triangle_edges(triangle, 1) == edge ? 1 : 2;
  }
};

// Indices must lie in [0, vertex_count) and differ within a triangle (assert; readers check and throw).
Surface make_surface(int vertex_count, const Triangles& triangles);

std::vector<int> face_counts(const Surface&);  // of each edge the number of its triangles
bool is_closed(const Surface&);                // every edge has exactly two triangles

// Closed loops of boundary vertices, each in the direction of its triangles' edges and each vertex at most once in a
// loop. Edges that do not close, which only triangles of clashing orientation have, are left out.
std::vector<std::vector<int>> boundary_loops(const Surface&);

// The edges at a vertex between two of its triangles, going round in one direction, each with the triangle before it;
// nothing if a boundary or a branching edge comes between.
struct EdgeRound {
  int edge, triangle;
};
std::optional<std::vector<EdgeRound>> edges_round(const Surface&, int vertex, int from, int to, bool forward);

double mean_edge(const Surface&, const Points&);  // length [m]; 0 without edges

// Area-weighted unit vertex normals, n x 3; zero at isolated vertices.
Points vertex_normals(const Surface&, const Points&);

}  // namespace selvedge

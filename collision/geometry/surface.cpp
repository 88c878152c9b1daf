#include "collision/geometry/surface.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>

#include "collision/geometry/disjoint_sets.hpp"

namespace selvedge {
namespace {

struct HalfEdge {
  int lo, hi, triangle, corner;
};

std::vector<HalfEdge> sorted_half_edges(const Triangles& triangles) {
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * static_cast<std::size_t>(triangles.rows()));
  for (int t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(t, k), b = triangles(t, (k + 1) % 3);
      half_edges.push_back({std::min(a, b), std::max(a, b), t, k});
    }
  std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.lo, a.hi, a.triangle) < std::tie(b.lo, b.hi, b.triangle);
  });
  return half_edges;
}

void make_edges(Surface& s) {
  const std::vector<HalfEdge> half_edges = sorted_half_edges(s.triangles);
  s.triangle_edges.resize(s.triangles.rows(), 3);
  std::vector<std::array<int, 2>> edges;
  for (std::size_t begin = 0, end = 0; begin < half_edges.size(); begin = end) {
    const HalfEdge& first = half_edges[begin];
    while (end < half_edges.size() && half_edges[end].lo == first.lo && half_edges[end].hi == first.hi) ++end;
    for (std::size_t i = begin; i < end; ++i)
      s.triangle_edges(half_edges[i].triangle, half_edges[i].corner) = static_cast<int>(edges.size());
    edges.push_back({first.lo, first.hi});
    s.edge_triangles.push_back({first.triangle, end - begin > 1 ? half_edges[begin + 1].triangle : -1});
    s.edge_owner.push_back(first.triangle);
    if (end - begin > 2) ++s.nonmanifold_edges;
  }
  s.edges.resize(static_cast<Eigen::Index>(edges.size()), 2);
  for (std::size_t e = 0; e < edges.size(); ++e) s.edges.row(static_cast<Eigen::Index>(e)) << edges[e][0], edges[e][1];
}

void make_vertex_triangles(Surface& s) {
  const std::span<const int> corners(s.triangles.data(), static_cast<std::size_t>(s.triangles.size()));
  s.vertex_triangles = indices_by_value(corners, s.vertex_count);
  for (int& t : s.vertex_triangles.item) t /= 3;
  for (int v = 0; v < s.vertex_count; ++v)
    s.vertex_owner.push_back(s.triangles_of(v).empty() ? -1 : s.triangles_of(v).front());
  s.isolated_vertices = static_cast<int>(std::count(s.vertex_owner.begin(), s.vertex_owner.end(), -1));
}

void make_components(Surface& s) {
  DisjointSets sets(s.vertex_count);
  for (int e = 0; e < s.edges.rows(); ++e) sets.join(s.edges(e, 0), s.edges(e, 1));
  s.component = sets.numbers();
  s.component_count = sets.count();
}

}  // namespace

Surface make_surface(int vertex_count, const Triangles& triangles) {
  assert(triangles.size() == 0 || (triangles.minCoeff() >= 0 && triangles.maxCoeff() < vertex_count));
  Surface s;
  s.vertex_count = vertex_count;
  s.triangles = triangles;
  make_edges(s);
  make_vertex_triangles(s);
  make_components(s);
  return s;
}

double mean_edge(const Surface& surface, const Points& x) {
  double sum = 0;
  for (const auto& edge : surface.edges.rowwise()) sum += (x.row(edge[0]) - x.row(edge[1])).norm();
  return surface.edges.rows() > 0 ? sum / static_cast<double>(surface.edges.rows()) : 0;
}

std::vector<int> face_counts(const Surface& s) {
  std::vector<int> count(static_cast<std::size_t>(s.edges.rows()), 0);
  for (const int edge : s.triangle_edges.reshaped()) ++count[edge];
  return count;
}

bool is_closed(const Surface& s) {
  return s.triangles.rows() > 0 && s.nonmanifold_edges == 0 &&
         std::all_of(s.edge_triangles.begin(), s.edge_triangles.end(), [](const auto& t) { return t[1] >= 0; });
}

std::vector<std::vector<int>> boundary_loops(const Surface& s) {
  std::vector<std::vector<int>> out(s.vertex_count);  // ends of the boundary edges that leave a vertex, last one first
  for (int t = static_cast<int>(s.triangles.rows()) - 1; t >= 0; --t)
    for (int k = 0; k < 3; ++k)
      if (s.edge_triangles[s.triangle_edges(t, k)][1] < 0)
        out[s.triangles(t, k)].push_back(s.triangles(t, (k + 1) % 3));
  std::vector<std::vector<int>> loops;
  std::vector<int> place(s.vertex_count, -1);  // in the walk, -1: not in it
  for (int v = 0; v < s.vertex_count; ++v) {
    std::vector<int> walk;
    for (int w = v;;) {
      if (place[w] >= 0) {  // closes a loop; at a vertex of two loops this happens before the walk is back at its start
        const auto first = walk.begin() + place[w];
        loops.emplace_back(first, walk.end());
        for (int left : loops.back()) place[left] = -1;
        walk.erase(first, walk.end());
      }
      if (out[w].empty()) break;
      place[w] = static_cast<int>(walk.size());
      walk.push_back(w);
      w = out[w].back();
      out[walk.back()].pop_back();
    }
    for (int left : walk) place[left] = -1;
  }
  return loops;
}

std::optional<std::vector<EdgeRound>> edges_round(const Surface& surface, int vertex, int from, int to, bool forward) {
  std::vector<EdgeRound> edges;
  int previous = -1;
  for (int t = from; t != to;) {
    const int k = surface.corner_of(t, vertex);
    const int ahead = surface.triangle_edges(t, k), behind = surface.triangle_edges(t, (k + 2) % 3);
    const int edge = previous < 0 ? (forward ? ahead : behind) : (ahead == previous ? behind : ahead);
    edges.push_back({edge, t});
    previous = edge;
    t = surface.across(edge, t);
    if (t < 0 || t == from || edges.size() > surface.triangles_of(vertex).size()) return std::nullopt;
  }
  return edges;
}

Points vertex_normals(const Surface& s, const Points& x) {
  const int faces = static_cast<int>(s.triangles.rows());
  Points areas(faces, 3), normals(s.vertex_count, 3);
#pragma omp parallel if (faces > 1000)
  {
#pragma omp for schedule(static)
    for (int t = 0; t < faces; ++t) {
      const Vec3 a = row(x, s.triangles(t, 0));
      areas.row(t) = (row(x, s.triangles(t, 1)) - a).cross(row(x, s.triangles(t, 2)) - a).transpose();
    }
#pragma omp for schedule(static)
    for (int v = 0; v < s.vertex_count; ++v) {
      Vec3 sum = Vec3::Zero();
      for (const int t : s.triangles_of(v)) sum += row(areas, t);
      const double length = sum.norm();
      normals.row(v) = (length > 0 ? Vec3(sum / length) : sum).transpose();
    }
  }
  return normals;
}

}  // namespace selvedge

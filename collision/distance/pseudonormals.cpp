#include "collision/distance/pseudonormals.hpp"

#include <cmath>

#include "collision/geometry/corners.hpp"

namespace selvedge {
namespace {

Vec3 unit_or_zero(const Vec3& v) {
  const double length = v.norm();
  return length > 1e-12 ? Vec3(v / length) : Vec3::Zero();
}

// Does the triangle run along the edge from its lower to its higher vertex?
bool passes_upward(const Surface& surface, int triangle, int edge) {
  const int k = surface.side_of(triangle, edge);
  return surface.triangles(triangle, k) < surface.triangles(triangle, (k + 1) % 3);
}

// The number of triangles in the fan of the vertex's first triangle: all that are reached by turning round the vertex.
int fan_size(const Surface& surface, int vertex) {
  const int first = surface.triangles_of(vertex).front();
  int at = first, size = 0;
  do {
    const int k = surface.corner_of(at, vertex);
    at = surface.across(surface.triangle_edges(at, (k + 2) % 3), at);  // the edge that enters
    ++size;
  } while (at != first);
  return size;
}

}  // namespace

bool is_closed_manifold(const Surface& surface) {
  if (!is_closed(surface)) return false;
  for (int e = 0; e < surface.edges.rows(); ++e)
    if (passes_upward(surface, surface.edge_triangles[e][0], e) ==
        passes_upward(surface, surface.edge_triangles[e][1], e))
      return false;
  for (int v = 0; v < surface.vertex_count; ++v)
    if (const std::size_t all = surface.triangles_of(v).size();
        all > 0 && fan_size(surface, v) != static_cast<int>(all))
      return false;
  return true;
}

Vec3 face_normal(const Surface& surface, const Points& x, int t) {
  const Vec3 normal = twice_area(surface.triangles, x, t);
  const double length = normal.norm();
  return length > 0 ? Vec3(normal / length) : Vec3::Zero();
}

Vec3 edge_pseudonormal(const Surface& surface, const Points& x, int edge) {
  Vec3 sum = Vec3::Zero();
  for (const int t : surface.edge_triangles[edge]) {
    if (t < 0) continue;
    const Vec3 normal = face_normal(surface, x, t);
    if (normal.isZero(0)) return Vec3::Zero();
    sum += normal;
  }
  return unit_or_zero(sum);
}

Vec3 vertex_pseudonormal(const Surface& surface, const Points& x, int vertex) {
  Vec3 sum = Vec3::Zero();
  for (const int t : surface.triangles_of(vertex)) {
    const int k = surface.corner_of(t, vertex);
    const Vec3 at = row(x, vertex);
    const Vec3 p = row(x, surface.triangles(t, (k + 1) % 3)) - at, q = row(x, surface.triangles(t, (k + 2) % 3)) - at;
    const Vec3 normal = p.cross(q);
    const double length = normal.norm();
    if (!(length > 0)) return Vec3::Zero();
    sum += std::atan2(length, p.dot(q)) / length * normal;
  }
  return unit_or_zero(sum);
}

}  // namespace selvedge

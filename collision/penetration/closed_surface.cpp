#include "collision/penetration/closed_surface.hpp"

#include <algorithm>
#include <string>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

std::vector<std::vector<int>> holes_to_close(const Surface& cloth, std::span<const int> open) {
  std::vector<std::vector<int>> loops = boundary_loops(cloth);
  for (const int vertex : open) {
    const auto has = [vertex](const std::vector<int>& loop) { return std::ranges::find(loop, vertex) != loop.end(); };
    if (std::ranges::none_of(boundary_loops(cloth), has))
      throw Error("vertex " + std::to_string(vertex) + " is on no boundary", "holes of a garment that stay open",
                  "name a vertex on the hole's boundary");
    std::erase_if(loops, has);
  }
  return loops;
}

Surface with_fans(const Surface& cloth, const std::vector<std::vector<int>>& loops) {
  Eigen::Index count = cloth.triangles.rows();
  for (const std::vector<int>& loop : loops) count += static_cast<Eigen::Index>(loop.size());
  Triangles triangles(count, 3);
  triangles.topRows(cloth.triangles.rows()) = cloth.triangles;
  Eigen::Index at = cloth.triangles.rows();
  int centre = cloth.vertex_count;
  for (const std::vector<int>& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) triangles.row(at++) << loop[(i + 1) % loop.size()], loop[i], centre;
    ++centre;
  }
  return make_surface(centre, triangles);
}

std::vector<int> garments_of_triangles(const Surface& cloth, const Surface& closed, std::span<const int> garments) {
  if (!garments.empty() && static_cast<int>(garments.size()) != cloth.vertex_count)
    throw Error("a garment is needed for each vertex", "closed garments", "");
  std::vector<int> garment;
  for (const auto& triangle : closed.triangles.rowwise())  // a fan's first corner is one of the cloth
    garment.push_back(garments.empty() ? cloth.component[triangle[0]] : garments[triangle[0]]);
  return garment;
}

int corner_at_edge(const Surface& surface, int triangle, int edge) {
  const auto& edges = surface.triangle_edges;
  return edges(triangle, 0) == edge ? 0 : edges(triangle, 1) == edge ? 1 : 2;
}

// Do both triangles of an edge run along it from the same end?
bool same_direction(const Surface& surface, int edge, int a, int b) {
  const int i = corner_at_edge(surface, a, edge), j = corner_at_edge(surface, b, edge);
  return surface.triangles(a, i) == surface.triangles(b, j);
}

// Sets `turn` and `orientable`, neighbour by neighbour.
void turn_alike(ClosedSurface& closed) {
  const Surface& surface = closed.surface;
  const int count = static_cast<int>(surface.triangles.rows());
  std::vector<int> uses(static_cast<std::size_t>(surface.edges.rows()), 0);
  for (const int edge : surface.triangle_edges.reshaped()) ++uses[edge];
  closed.turn.assign(static_cast<std::size_t>(count), 0);
  closed.orientable.assign(static_cast<std::size_t>(surface.component_count), 1);
  for (int seed = 0; seed < count; ++seed) {
    if (closed.turn[seed] != 0) continue;
    closed.turn[seed] = 1;
    for (std::vector<int> stack{seed}; !stack.empty();) {
      const int t = stack.back();
      stack.pop_back();
      for (int k = 0; k < 3; ++k) {
        const int edge = surface.triangle_edges(t, k);
        const auto [first, second] = surface.edge_triangles[edge];
        const int next = first == t ? second : first;
        char& orientable = closed.orientable[surface.component[surface.triangles(t, 0)]];
        if (uses[edge] > 2) orientable = 0;
        if (next < 0 || next == t) continue;
        const int wanted = same_direction(surface, edge, t, next) ? -closed.turn[t] : closed.turn[t];
        if (closed.turn[next] == 0) {
          closed.turn[next] = static_cast<signed char>(wanted);
          stack.push_back(next);
        } else if (closed.turn[next] != wanted) {
          orientable = 0;
        }
      }
    }
  }
}

}  // namespace

ClosedSurface close_surface(const Surface& cloth, std::span<const int> garments, std::span<const int> open) {
  ClosedSurface closed;
  closed.cloth_vertices = cloth.vertex_count;
  closed.cloth_triangles = static_cast<int>(cloth.triangles.rows());
  closed.loops = holes_to_close(cloth, open);
  closed.surface = with_fans(cloth, closed.loops);
  closed.garment = garments_of_triangles(cloth, closed.surface, garments);
  turn_alike(closed);
  closed.component_faces.assign(static_cast<std::size_t>(closed.surface.component_count), 0);
  for (const auto& triangle : closed.surface.triangles.rowwise())
    ++closed.component_faces[closed.surface.component[triangle[0]]];
  return closed;
}

Points closed_positions(const ClosedSurface& closed, const Points& cloth) {
  Points x(closed.surface.vertex_count, 3);
  x.topRows(closed.cloth_vertices) = cloth;
  int centre = closed.cloth_vertices;
  for (const std::vector<int>& loop : closed.loops) {
    Vec3 sum = Vec3::Zero();
    for (const int v : loop) sum += row(cloth, v);
    x.row(centre++) = (sum / static_cast<double>(loop.size())).transpose();
  }
  return x;
}

Points by_cloth_positions(const ClosedSurface& closed, const Points& gradient) {
  Points result = gradient.topRows(closed.cloth_vertices);
  int centre = closed.cloth_vertices;
  for (const std::vector<int>& loop : closed.loops) {
    for (const int v : loop) result.row(v) += gradient.row(centre) / static_cast<double>(loop.size());
    ++centre;
  }
  return result;
}

}  // namespace selvedge

#include "collision/penetration/closed_surface.hpp"

#include <algorithm>
#include <string>

#include "collision/geometry/corners.hpp"
#include "collision/geometry/error.hpp"
#include "collision/geometry/turned_alike.hpp"

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
  for (const auto& triangle : closed.triangles.rowwise())  // a fan's first corner is a cloth vertex
    garment.push_back(garments.empty() ? cloth.component[triangle[0]] : garments[triangle[0]]);
  return garment;
}

// Sets `turn` and `orientable`.
void turn_alike(ClosedSurface& closed) {
  const Surface& surface = closed.surface;
  TurnedAlike alike = turned_alike(surface);
  closed.orientable.assign(static_cast<std::size_t>(surface.component_count), 1);
  for (int t = 0; t < surface.triangles.rows(); ++t)
    if (!alike.orientable[alike.part[t]]) closed.orientable[surface.component[surface.triangles(t, 0)]] = 0;
  closed.turn = std::move(alike.turn);
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

Vec3 turned_normal(const ClosedSurface& closed, const Points& x, int face) {
  return closed.turn[face] * twice_area(closed.surface.triangles, x, face);
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

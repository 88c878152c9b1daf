#pragma once

#include <span>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// A cloth whose holes are closed, each by a fan from its boundary to the mean of the boundary's vertices (Liao et al.
// 2024, algorithm 1, steps 2 to 7). The cloth is left as it is: its vertices and triangles come first, those of the
// fans behind them. Built once, constant afterwards; positions live outside.
struct ClosedSurface {
  Surface surface;
  int cloth_vertices = 0, cloth_triangles = 0;
  std::vector<std::vector<int>> loops;  // of the closed holes; the centre of loop i is vertex cloth_vertices + i
  std::vector<int> garment;             // of each triangle
  std::vector<signed char> turn;        // of each triangle, +1 or -1: neighbours are turned alike
  std::vector<char> orientable;         // of each component: it can be, and no edge has three triangles
  std::vector<int> component_faces;     // of each component: its triangles

  bool is_fan(int triangle) const { return triangle >= cloth_triangles; }
};

// `garments` names the garment of each vertex (of a triangle: that of its first); empty: each component is one. A hole
// with one of the vertices `open` on its boundary stays open. Throws Error for a list of another length, or for a
// vertex that is on no boundary.
ClosedSurface close_surface(const Surface& cloth, std::span<const int> garments = {}, std::span<const int> open = {});

// Cloth positions [m] with the centres of the fans behind them.
Points closed_positions(const ClosedSurface&, const Points& cloth);

// A derivative by closed_positions as one by the cloth's positions: a loop's n vertices get 1/n of their centre's each.
Points by_cloth_positions(const ClosedSurface&, const Points& gradient);

}  // namespace selvedge

#pragma once

#include <span>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// A cloth whose holes are closed, each by a fan from its boundary to the mean of the boundary's vertices (Liao et al.
// 2024, algorithm 1, steps 2 to 7). The cloth is left as it is: its vertices and triangles come first, then those of
// the fans. Built once, constant afterwards; positions live outside.
struct ClosedSurface {
  Surface surface;
  int cloth_vertices = 0, cloth_triangles = 0;
  std::vector<std::vector<int>> loops;  // of the closed holes; the centre of loop i is vertex cloth_vertices + i
  std::vector<int> garment;             // of each triangle
  std::vector<signed char> turn;        // of each triangle, +1 or -1: neighbours are turned alike
  std::vector<char> orientable;         // of each component: 1 if such turns exist and no edge has three triangles
  std::vector<int> component_faces;     // of each component: its triangles

  bool is_fan(int triangle) const { return triangle >= cloth_triangles; }
};

// `garments`: the garment's number of each vertex; a triangle has that of its first vertex. Empty: each component is a
// garment. A hole with one of the vertices `open` on its boundary stays open. Throws Error if `garments` has another
// length, or if a vertex of `open` is on no boundary.
ClosedSurface close_surface(const Surface& cloth, std::span<const int> garments = {}, std::span<const int> open = {});

// Cloth positions [m], then the centres of the fans.
Points closed_positions(const ClosedSurface&, const Points& cloth);

// Twice the vector area of a face, with its turn; x: closed_positions.
Vec3 turned_normal(const ClosedSurface&, const Points& x, int face);

// Turns a derivative by closed_positions into one by the cloth's positions: each of a loop's n vertices gets 1/n of the
// centre's.
Points by_cloth_positions(const ClosedSurface&, const Points& gradient);

}  // namespace selvedge

#pragma once

#include <cstdint>
#include <span>

#include "pipeline/mesh_io.hpp"

namespace selvedge {

enum class Triangulation { one_diagonal, alternating, unstructured };

struct SheetOptions {
  Triangulation triangulation = Triangulation::alternating;
  std::uint64_t seed = 1;  // of unstructured meshes: the same seed gives the same mesh
};

// Cloths lie in their flat coordinates uv [m], one row a vertex (uv_triangles = triangles), with named groups.

// columns x rows vertices (at least 2 x 2), horizontal and centred at the origin, normal +Y, u along +X, v along -Z.
// Unstructured meshes have one vertex more in every second row. Groups: left right top bottom boundary center and the
// corners top_left top_right bottom_left bottom_right, as seen from above with -Z up.
Mesh make_rectangle(const Vec2& size, int columns, int rows, const SheetOptions&);

// Rings of 6, 12, 18 ... vertices round a centre, normal +Y. Groups: boundary center. rings >= 1.
Mesh make_disc(double radius, int rings, const SheetOptions&);

// around x rows vertices on a cylinder about Y, centred at the origin, normals outward; no uv, since it closes.
// Groups: top bottom boundary. around >= 6, rows >= 2.
Mesh make_tube(double radius, double height, int around, int rows, const SheetOptions&);

// Triangles between two rows of vertices whose positions along the row ascend; `above` lies to the left of the
// direction of ascent, so that triangles come out counter-clockwise.
void add_strip(std::vector<std::array<int, 3>>& triangles, std::span<const int> below, std::span<const double> u_below,
               std::span<const int> above, std::span<const double> u_above);

Triangles to_triangles(const std::vector<std::array<int, 3>>&);

using Points2 = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

// Moves every free vertex by up to `amount` [m] without turning a triangle over, smooths a little, and flips edges
// until the mesh is Delaunay (Lawson 1977). With period > 0 the first coordinate wraps round.
void make_unstructured(Points2& uv, Triangles&, const std::vector<bool>& fixed, double amount, std::uint64_t seed,
                       double period = 0);

}  // namespace selvedge

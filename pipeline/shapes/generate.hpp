#pragma once

#include <cstdint>
#include <span>

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

enum class Triangulation { one_diagonal, alternating, unstructured };

// How a sheet is divided into triangles. Members are described where keys are bound to them:
// pipeline/scene/config_sheets.cpp.
struct SheetOptions {
  Triangulation triangulation = Triangulation::alternating;
  std::uint64_t seed = 1;
};

// All cloths have flat coordinates uv [m], one row per vertex (uv_triangles = triangles), and named groups.

// columns x rows vertices (at least 2 x 2), horizontal and centred at the origin, normal +Y, u along +X, v along -Z.
// Unstructured meshes have one vertex more in every second row. Groups: left right top bottom boundary center and the
// corners top_left top_right bottom_left bottom_right, as seen from above with -Z up.
Mesh make_rectangle(const Vec2& size, int columns, int rows, const SheetOptions&);

// Moves the vertices of a structured rectangle along its sides so that spacings grow geometrically: the last is
// `grading` times the first along u and along -v.
void grade_rectangle(Mesh&, const Vec2& size, int columns, int rows, const Vec2& grading);

// Rings of 6, 12, 18 ... vertices round a centre, normal +Y. Groups: boundary center. rings >= 1.
Mesh make_disc(double radius, int rings, const SheetOptions&);

// around x rows vertices on a cylinder about Y, centred at the origin, normals outward; no uv, since it closes.
// Groups: top bottom boundary. around >= 6, rows >= 2.
Mesh make_tube(double radius, double height, int around, int rows, const SheetOptions&);

// A point of a centre line and the direction that the ribbon faces there, which need not be perpendicular to the line.
struct LinePoint {
  Vec3 at, normal;
};

// A strip laid along a smooth line (centripetal Catmull-Rom) through at least two points: along x across vertices,
// u along the line, v to its left as the normal is seen from above; the pattern is a flat rectangle as long as the
// line. No normal may be along the line. Groups: start end middle boundary.
Mesh make_ribbon(const std::vector<LinePoint>& line, double width, int along, int across, const SheetOptions&);

// Length of that line [m], and the least angle between a normal and the line [rad].
double line_length(const std::vector<LinePoint>& line);
double least_normal_angle(const std::vector<LinePoint>& line);

// The shape of a T-shirt. Members are described where keys are bound to them: pipeline/scene/config_sheets.cpp.
struct TshirtShape {
  double width = 0.5, length = 0.65;
  double sleeve_length = 0.15, sleeve_width = 0.2;
  double neck = 0.2;
  double depth = 0.04;
  double edge = 0.02;
};

// A T-shirt of a front and a back with straight edges, joined at sides, shoulders and sleeves; upright, front to +Z,
// normals outward, centred at the origin; no uv, since it is sewn. Groups: hem neck cuffs seams front back.
Mesh make_tshirt(const TshirtShape&);

// Triangles between two rows of vertices whose positions along the row ascend; `above` lies to the left of the
// direction of ascent, so that triangles come out counter-clockwise.
void add_strip(std::vector<std::array<int, 3>>& triangles, std::span<const int> below, std::span<const double> u_below,
               std::span<const int> above, std::span<const double> u_above);

// Two triangles of the quad a b c d (counter-clockwise), cut from a to c or from b to d.
void add_quad(std::vector<std::array<int, 3>>& triangles, int a, int b, int c, int d, bool from_a);

// Whether the quad in column i and row j is cut from its first corner.
bool cut_from_a(Triangulation, int i, int j);

Points to_points(const std::vector<Vec3>&);
Triangles to_triangles(const std::vector<std::array<int, 3>>&);

using Points2 = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

// Flips edges until the mesh is Delaunay (Lawson 1977). With period > 0 the first coordinate wraps round.
void make_delaunay(const Points2& uv, Triangles&, double period = 0);

// Moves every free vertex by up to `amount` [m] without turning a triangle over, smooths a little, and makes
// the mesh Delaunay.
void make_unstructured(Points2& uv, Triangles&, const std::vector<bool>& fixed, double amount, std::uint64_t seed,
                       double period = 0);

}  // namespace selvedge

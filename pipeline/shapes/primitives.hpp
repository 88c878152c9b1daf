#pragma once

#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Triangle surfaces of obstacles, centred at the origin, normals outward; edges are at most about `edge` long [m].
struct Shape {
  Points x;
  Triangles triangles;
};

Shape make_plane(const Vec2& size, double edge);                // horizontal, normal +Y
Shape make_sphere(double radius, double edge);                  // geodesic: subdivided icosahedron, 10 n^2 + 2 vertices
Shape make_capsule(double radius, double length, double edge);  // along Y; length of the cylinder between the caps
Shape make_box(const Vec3& size, double edge);

// A line of at least two points (distance from the axis, height) turned round Y. With `closed` the line closes on
// itself; every distance must then be above 0. Otherwise it runs as given, and the surface is closed if both ends are
// on the axis.
Shape make_revolution(const std::vector<Vec2>& profile, bool closed, double edge);

// The approximate number of vertices of a shape with this area, to refuse absurd edge lengths before memory runs out.
double vertices_for(double area, double edge);

}  // namespace selvedge

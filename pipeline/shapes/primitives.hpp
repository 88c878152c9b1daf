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

// A line of at least two points (distance from the axis, height) turned round Y. It closes on itself (`closed`, then
// every distance is above 0), or runs as given; where both ends lie on the axis the surface is closed as well.
Shape make_revolution(const std::vector<Vec2>& profile, bool closed, double edge);

// Vertices that a shape of this area would have, for refusing absurd edge lengths before memory runs out.
double vertices_for(double area, double edge);

}  // namespace selvedge

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace selvedge {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

// Positions or velocities, n x 3, SI units, one row a vertex.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
// Vertex indices, m x 3, counter-clockwise seen from outside.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;
// Vertex indices, m x 2, smaller index first.
using Edges = Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>;

inline Vec3 row(const Points& points, int vertex) { return points.row(vertex).transpose(); }

// The largest absolute value among all coordinates; 0 without rows. All must be numbers.
inline double largest_coordinate(const Points& x) { return x.rows() > 0 ? x.cwiseAbs().maxCoeff() : 0.0; }

// Twice the signed area of the triangle 0, a, b: positive where b lies counter-clockwise of a.
inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace selvedge

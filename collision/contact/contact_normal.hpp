#pragma once

#include "collision/contact/contact_pairs.hpp"

namespace selvedge {

// The direction in which a pair pushes. It is `between`, the vector between the closest points, unless the pair's point
// on a body is not the body's closest point: of two edges, or of a body's vertex and a face of the cloth, another face
// of the body may be nearer. Otherwise cloth that is not quite level would be pushed aside over the edges of a level
// floor. Such a pair pushes along the nearest normal in the cone of normals of the faces that meet there (as in Provot
// 1997). Pairs of cloth push along `between`: their forces are internal and leave the mean motion as it is, and normals
// of coarse cloth turn so much that pushing along them would add energy. `weights`: of the closest points, at `time` in
// [0, 1] of the motion from x0 to x1. Returns a unit vector; along `between` where that is perpendicular to all
// normals.
Vec3 contact_normal(const ContactWorld&, const NodePair&, const Eigen::Vector4d& weights, const Vec3& between,
                    const Points& x0, const Points& x1, double time);
inline Vec3 contact_normal(const ContactWorld& world, const NodePair& pair, const Eigen::Vector4d& weights,
                           const Vec3& between, const Points& x) {
  return contact_normal(world, pair, weights, between, x, x, 0);
}

}  // namespace selvedge

#pragma once

#include "collision/contact/contact_pairs.hpp"

namespace selvedge {

// The direction in which a pair pushes: that of `between`, the vector between its closest points, where the surface of
// a body agrees. Two edges, or a vertex of a body and a face of the cloth, may be closest in a direction in which the
// body has something nearer beside them: over the edges of a level floor a cloth that is not quite level would be
// pushed aside. What is no closest point of its body pushes along the nearest normal of the faces that meet there (the
// cone of normals at an edge or a vertex, as in Provot 1997). Pairs of cloth push along `between`: their forces are
// internal and move no mean, and normals of coarse cloth turn so much that pushing along them makes energy. weights: of
// the closest points, at the part `time` of the motion from x0 to x1. Unit; as `between` where that lies across
// all normals.
Vec3 contact_normal(const ContactWorld&, const NodePair&, const Eigen::Vector4d& weights, const Vec3& between,
                    const Points& x0, const Points& x1, double time);
inline Vec3 contact_normal(const ContactWorld& world, const NodePair& pair, const Eigen::Vector4d& weights,
                           const Vec3& between, const Points& x) {
  return contact_normal(world, pair, weights, between, x, x, 0);
}

}  // namespace selvedge

#pragma once

#include "collision/contact/contact_pairs.hpp"

namespace selvedge {

// The direction in which a pair pushes: that of `between`, the vector between its closest points as far
// as the surfaces round these points agree. Two edges, or a vertex of a body and a face of the cloth, may be closest in
// a direction in which the surface on one side has something nearer beside them: over the edges of a level floor a
// cloth that is not quite level would be pushed aside, and edges that are almost parallel push anywhere. What is no
// closest point of its surface pushes along the nearest normal of the faces that meet there (the cone of normals at an
// edge or a vertex, as in Provot 1997). Of a body and the cloth the body's surface counts, of two edges of the cloth
// both. weights: of the closest points, where everything is `time` of the way from x0 to x1. Unit; as `between` where
// that lies across all normals.
Vec3 contact_normal(const ContactWorld&, const NodePair&, const Eigen::Vector4d& weights, const Vec3& between,
                    const Points& x0, const Points& x1, double time);
inline Vec3 contact_normal(const ContactWorld& world, const NodePair& pair, const Eigen::Vector4d& weights,
                           const Vec3& between, const Points& x) {
  return contact_normal(world, pair, weights, between, x, x, 0);
}

}  // namespace selvedge

#pragma once

#include <array>
#include <vector>

#include "pipeline/hdf5/trajectory.hpp"

namespace selvedge {

// Where each vertex of a mesh is beside a surface: a point of its nearest triangle, and the way from there in the frame
// of that triangle (along its first edge, across it, along its normal).
struct Binding {
  struct Place {
    std::array<int, 3> corners{};     // vertices of the surface
    std::array<double, 3> weights{};  // of them, sum 1
    Vec3 away = Vec3::Zero();         // [m]
  };
  std::vector<Place> places;
  double mean_distance = 0;  // from the surface [m]
};

// Binds vertices x to the surface at rest. Both are in the same place and unit [m].
Binding bound_to(const Points& rest, const Triangles&, const Points& x);

// The bound vertices with the surface at x.
PointsF driven(const Binding&, const PointsF& x);

}  // namespace selvedge

#pragma once

#include <span>
#include <vector>

#include "collision/geometry/adjacency.hpp"
#include "collision/geometry/surface.hpp"

namespace selvedge {

// The shape of the input, with which the repaired cloth is compared.
struct InputShape {
  const Surface* surface = nullptr;
  Points x0;
  Adjacency neighbours;                       // along edges
  std::vector<double> edge_length;            // mean over each vertex' edges [m]
  std::vector<Eigen::Matrix2d> rest_inverse;  // of each triangle's two edges in its plane
  std::vector<char> measured;  // 0: the input triangle has no area, so that its stretches are not defined
  double mean_edge = 0;        // [m]
};

InputShape input_shape(const Surface&, const Points& x0);

// Vertices within `rings` edges of the marked ones, these included.
std::vector<char> within_rings(const InputShape&, const std::vector<char>& marked, int rings);

struct StretchRange {
  double least = 1, largest = 1;
};

// Singular values of the deformation of a triangle from the input to x.
StretchRange stretch_of(const InputShape&, const Points& x, int triangle);
StretchRange extreme_stretch(const InputShape&, const Points& x);

// Blends the displacement x - from of each listed vertex with the mean displacement of its neighbours, by `share`.
void smooth_displacement(const InputShape&, const Points& from, std::span<const int> vertices, double share, Points& x);

// One pass over the triangles that brings those stretched out of the range back to it. Vertices with `reach` 0 stay.
void limit_stretch(const InputShape&, std::span<const int> triangles, const std::vector<double>& reach,
                   const StretchRange& range, Points& x);

// Brings each vertex back to within its reach of x0.
void limit_displacement(const InputShape&, std::span<const int> vertices, const std::vector<double>& reach, Points& x);

// Moves vertices with `offends` 1 part of the way back to `before`, in late rounds all of it, and sets `offends` to 0.
void take_back(std::vector<char>& offends, int round, const Points& before, Points& x);

// Moves vertices back toward `before`, where every triangle was in the range, until every triangle is in it again.
void hold_back(const InputShape&, std::span<const int> triangles, const StretchRange& range, const Points& before,
               Points& x);

}  // namespace selvedge

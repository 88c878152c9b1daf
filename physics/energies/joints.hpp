#pragma once

#include <span>
#include <vector>

#include "physics/scene/joint_lists.hpp"

namespace selvedge {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

// Of a spring: k (l - L)^2 / 2 [J], l the distance of the two vertices and L the rest length.
double joint_energy(const Spring&, const Points& x);

// Gradient in the order xa ya za xb yb zb [N] and the Hessian projected to PSD in closed form [N/m]: where the spring
// is compressed, it has no stiffness across its direction. Exact Hessian with psd = false. At zero length there is no
// direction: no force, and the stiffness is the same all round, which for L = 0 is exact. Returns the energy.
double joint_derivatives(const Spring&, const Points& x, Vec6& gradient, Mat6* hessian, bool psd = true);

// The scene's joints join parts 0 .. parts - 1, of which every vertex belongs to one. Returns for each part the lowest
// part of its joined set; a part without a joint is its own set. With `there`, joints with a vertex that it does not
// mark are left out.
std::vector<int> joined_parts(const Scene&, std::span<const int> part_of_vertex, int parts,
                              std::span<const char> there = {});

// The connected component of each vertex; components that joints join count as one.
std::vector<int> joined_components(const Scene&);

}  // namespace selvedge

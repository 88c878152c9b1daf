#pragma once

#include <span>

#include "collision/untangle/separation.hpp"

namespace selvedge {

// A displacement of a cloth near `wanted` that fulfils `pushes`, direction . sum w_i move_i >= least, as far as a few
// sweeps allow, without adding linear momentum. From each set of vertices that move together (joined by edges, or by a
// push) the mean by mass is subtracted; pushes move vertices by inverse mass [1/kg]. A set that pushes on something
// prescribed keeps its mean, since the reaction acts there: it has a push with an obstacle (weights do not sum to zero)
// or with a vertex of inverse mass 0. No vertex moves farther than `reach` [m]: `wanted` is cut to it, and a set that
// still moves too far is scaled as a whole. Displacements have one row per vertex [m].
Points balanced_motion(const Surface& cloth, const Eigen::VectorXd& inverse_mass, std::span<const Separation> pushes,
                       const Points& wanted, double reach);

}  // namespace selvedge

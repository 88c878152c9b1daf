#pragma once

#include <span>
#include <vector>

#include "collision/untangle/separation.hpp"

namespace selvedge {

// The displacement of a cloth that is to move by `wanted` and meets `pushes`, direction . sum w_i move_i >= least, as
// far as some sweeps over them come, without linear momentum: of vertices that move together (joined by edges, or by a
// push) the mean is taken away, by mass, and pushes move their vertices by inverse mass [1/kg]. A set that leans on
// something prescribed, by a push with an obstacle (whose weights do not add up to zero) or with a vertex of no inverse
// mass, is left its mean: the reaction goes there. No vertex moves farther than `reach` [m]: what is wanted beyond it
// is cut, and then a set that moves too far is shortened as a whole. Displacements have one row a vertex [m].
Points balanced_motion(const Surface& cloth, const Eigen::VectorXd& inverse_mass, std::span<const Separation> pushes,
                       const Points& wanted, double reach);

}  // namespace selvedge

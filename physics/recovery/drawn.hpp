#pragma once

#include <vector>

#include "collision/contact/exemption.hpp"
#include "physics/solve/implicit_euler.hpp"

namespace selvedge {

// Cloth at a part of a body that is switched off, since the body crosses itself there, has no room. Without help it
// would sink in, and be on the wrong side of a limb when the limb comes out again. So springs draw it to its skinned
// target (Drive::skinned_targets), which moves with the body. Contact with faces that are not switched off stays on.

// 1 for each dressed vertex of the cloth that is nearer than `reach` [m] to a switched-off node; empty if there is
// none.
std::vector<char> drawn_vertices(const ContactWorld&, const Exemption&, const Points& targets, const Points& nodes,
                                 double reach);

// Springs that draw the drawn vertices to their skinned targets, or to points `farthest` [m] from x0 toward them.
// Their stiffness is firmness * mass / h^2, with the step h [s].
AddedTerm drawing_term(const std::vector<char>& drawn, const Eigen::VectorXd& masses, const Points& x0,
                       const Points& targets, double farthest, double h, double firmness = 1);

// The sum of two terms, either of which may be empty.
AddedTerm sum_of(AddedTerm, AddedTerm);

}  // namespace selvedge

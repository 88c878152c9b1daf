#pragma once

#include <vector>

#include "collision/contact/exemption.hpp"
#include "physics/solve/implicit_euler.hpp"

namespace selvedge {

// Cloth at a part of a body that is switched off, since the body crosses itself there, has no place to be. Left to
// itself it would sink in, and where a limb comes out again it would be on its wrong side. So it is drawn to its
// skinned target (Drive::worn), which moves with the body; contact with what is not switched off holds as ever.

// The worn vertices that are nearer than `reach` [m] to a node that is switched off. 1 a vertex of the cloth; empty
// where there is none.
std::vector<char> carried_vertices(const ContactWorld&, const Exemption&, const Points& worn, const Points& nodes,
                                   double reach);

// Springs from the carried vertices to their skinned targets, or to points `farthest` [m] from x0 towards them,
// `firmness` times as stiff as their inertia over a step of h [s].
AddedTerm carrying_term(const std::vector<char>& carried, const Eigen::VectorXd& masses, const Points& x0,
                        const Points& worn, double farthest, double h, double firmness = 1);

// Both.
AddedTerm sum_of(AddedTerm, AddedTerm);

}  // namespace selvedge

#pragma once

#include "collision/contact/path_pairs.hpp"
#include "collision/contact/proximity.hpp"
#include "collision/contact/resolve_options.hpp"

namespace selvedge {

// Lets obstacles give way that would close on cloth without leaving it room, before the cloth is solved for. x1: a
// guess for the cloth's end, and the wanted ends of obstacles. On return obstacle nodes without room have moved back
// along the normals of the contacts between them. If they lag so much that their body would fold, nodes nearby lag with
// them. All other rows stay. Nodes that gave way get an inverse mass [1/kg], so that `resolve` may push them a little
// farther. Returns false if there is room everywhere.
//
// Pairs near the start, and those that meet on the way, each demand twice the separation, linearised. The cloth here
// has inertia but no elasticity or friction; so if the demands cannot be met, not even freely stretching and sliding
// cloth has room. Exactly where demands contradict each other, the multipliers of projected Gauss-Seidel grow without
// bound (Farkas: they tend to weights with which the demands sum to an impossible one).
bool make_room(PairSearch&, const ContactWorld&, const ResolveOptions&, std::span<const Proximity> near,
               const Points& x0, Points& x1, PathPairs&, Eigen::VectorXd& inverse_mass, ResolveReport&);

// Whether nodes are where they are wanted, up to the rounding of x + (wanted - x).
bool has_arrived(const Points& nodes, const Points& wanted);

// Moves all obstacles that ended a step short to where they are wanted, if their paths are free by now: demands
// linearised at the start may ask for more room than the cloth needed in the end. If anything meets on these paths, the
// report is not clean and `nodes` stay as they were.
ResolveReport catch_up(PairSearch&, const ResolveOptions&, const Eigen::VectorXd& inverse_mass, const Points& wanted,
                       Points& nodes, PathPairs&);

}  // namespace selvedge

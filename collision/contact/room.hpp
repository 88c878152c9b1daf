#pragma once

#include "collision/contact/proximity.hpp"
#include "collision/contact/resolve.hpp"

namespace selvedge {

// Lets obstacles that would close on cloth without leaving it room give way, before the cloth is solved for. x1: a
// guess of where the cloth goes, and where obstacles are wanted; on return obstacle nodes without room have given way
// along the normals of what is between them, and stop short of what they touch; if they lag by more than the distance
// to other nodes of their body allows without folding it, those lag with them. All other rows stay. Nodes that gave way
// get an inverse mass [1/kg], so that `resolve` may push them a little farther. False: there is room for all.
//
// The pairs near the start and those that meet on the way each ask for twice the separation, linearised. Nothing but
// inertia holds the cloth there, so that what finds no room finds none for cloth that stretches and slides as it likes.
// Where demands contradict each other, and only there, the multipliers of projected Gauss-Seidel grow without end
// (Farkas: they tend to weights under which the demands sum to an impossible one).
bool make_room(PairSearch&, const ContactWorld&, const ResolveOptions&, std::span<const Proximity> near,
               const Points& x0, Points& x1, PathPairs&, Eigen::VectorXd& inverse_mass, ResolveReport&);

// Where obstacles end a step short of where they are wanted, and the way there has come free meanwhile, takes all of
// them there: what is linearised at the start may ask for more room than the cloth needed in the end. Not clean, with
// `nodes` as they were, if something meets on that way.
ResolveReport catch_up(PairSearch&, const ResolveOptions&, const Eigen::VectorXd& inverse_mass, const Points& wanted,
                       Points& nodes, PathPairs&);

}  // namespace selvedge

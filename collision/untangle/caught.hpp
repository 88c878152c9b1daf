#pragma once

#include "collision/contact/exemption.hpp"

namespace selvedge {

// Cloth between two parts of a body that pass through each other has no room: contact with both parts would stop the
// body or tear the cloth. Contact leaves only this cloth alone; cloth from outside still meets all of the body.
//
// For an obstacle that moves from its nodes in `from` to those in `to` and crosses itself at either end. A vertex of
// the cloth is caught if the face in front of which it lies, moving with the body, takes it through another face that
// faces the first, of which at least one is near a crossing; or if the nearest face opposite to that one does so.
// Through a face of a closed shell it is caught only if it ends inside. A vertex that a body wears, and that the motion
// may bring to the crossing, is caught also where its skinned target ends inside of a closed shell: another part of the
// body has taken its place. An obstacle that keeps its shape catches no further vertices: its parts do not pass through
// each other. A vertex that is tangled with obstacles (`exemption.body`) within an edge of the crossing is caught too
// if a body wears it. `targets`: skinned targets, one row for each vertex, NaN where no body wears it; or empty. Marks
// caught vertices in exemption.switched_off, and if there are any also the obstacle's triangles that cross, are buried,
// or are next to such.
void switch_off(const ContactWorld&, int obstacle, const Points& from, const Points& to, const Points& targets,
                Exemption& exemption);

// The triangles of a surface at x that switch_off can mark: those that cross, are buried, or are next to such.
std::vector<int> may_be_switched_off(const Surface&, const Points& x);

// The number of switched-off triangles of each obstacle.
std::vector<int> switched_off_counts(const ContactWorld&, const Exemption&);

// Does the surface move from x0 to x1 as a rigid body?
bool moves_rigidly(const Surface&, const Points& x0, const Points& x1);

}  // namespace selvedge

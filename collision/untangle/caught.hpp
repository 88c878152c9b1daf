#pragma once

#include "collision/contact/exemption.hpp"

namespace selvedge {

// Cloth between two parts of a body that pass through each other has no place to be: contact with both would hold the
// body, or tear the cloth. It is let through, and nothing else is: what comes from outside meets all of the body.
//
// An obstacle goes from where it is in `from` to where it is in `to`, and crosses itself at one end at least. A vertex
// of the cloth is caught if the face before which it is would carry it through another one that faces that face, into
// the obstacle where its shells are closed. An obstacle that keeps its shape catches nothing anew: its parts do not
// pass through each other. A vertex is caught, too, if it is tangled with obstacles (`exemption.body`) within an edge
// of the crossing and worn: it has a place to be drawn to (`worn`, a row a vertex, not a number where nothing wears it;
// or empty). Marks what is caught, and where there is some `off` for the obstacle: triangles that cross, are buried, or
// are next to such.
void switch_off(const ContactWorld&, int obstacle, const Points& from, const Points& to, const Points& worn,
                Exemption& exemption);

// Triangles of a surface at x that switch_off can mark: they cross, are buried, or are next to such.
std::vector<int> may_be_off(const Surface&, const Points& x);

// Triangles that are off of each obstacle.
std::vector<int> switched_off(const ContactWorld&, const Exemption&);

// Does the surface move from x0 to x1 as a rigid body?
bool keeps_shape(const Surface&, const Points& x0, const Points& x1);

}  // namespace selvedge

#pragma once

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// Triangles that are cut out of cloth that starts tangled, so that the rest is clean from the first frame on: they take
// no part in physics and contact (cutting_stepper.hpp) until they are free. A triangle is free if it meets no other and
// has no vertex inside a closed obstacle, both in the positions as they are and rounded to float. A part that is left
// without pins, and separate from the largest part of its cloth, would fall. So it is cut out too, until free triangles
// or springs (stitches, buttons) connect it to the others again.

// Triangles to cut out at the start of a scene, ascending, among those with `may` 1. The others stay, tangled or not.
std::vector<int> cut_out_at_start(const Scene&, const State&, const std::vector<char>& may);

// The triangles of State::cut_out that have to stay out, ascending.
std::vector<int> still_cut_out(const Scene&, const State&);

// For each triangle of the scene, 1 if it is not in `cut_out`.
std::vector<char> all_but(const Scene&, const std::vector<int>& cut_out);

}  // namespace selvedge

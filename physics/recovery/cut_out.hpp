#pragma once

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// Triangles that are cut out of cloth that starts tangled, so that the rest is clean from the first frame on: they take
// no part in physics and contact (cutting_stepper.hpp) until they are free. A triangle is free if it neither meets
// anything nor has a vertex inside a closed obstacle, in the positions as they are and rounded to float. Parts that
// what is cut out leaves without pins and apart from the largest one of their cloth would fall: they are cut out, too,
// and come back together with a way to the others, stitches and buttons included.

// At the start of a scene: of the triangles that `may` marks, ascending. The others stay, tangled or not.
std::vector<int> cut_out_at_start(const Scene&, const State&, const std::vector<char>& may);

// What of State::cut_out has to stay out, ascending.
std::vector<int> still_cut_out(const Scene&, const State&);

// Of each triangle of the scene, 1 where it is not among these.
std::vector<char> all_but(const Scene&, const std::vector<int>& cut_out);

}  // namespace selvedge

#pragma once

#include <span>

#include "collision/contact/contact_world.hpp"
#include "collision/contact/resolve_options.hpp"
#include "collision/geometry/disjoint_sets.hpp"

namespace selvedge {

// Pins in sets that edges between pins join: each set is moved as one piece. Other nodes are sets of their own.
DisjointSets pin_patches(const ContactWorld&, std::span<const int> pins);

// Keeps pins of different patches apart in the motion x0 -> x1, as points: at one place they would leave the cloth
// round them no motion without a crossing. No two come nearer than twice the separation that contact keeps between
// them, or than they were. Pins that move give way: they slide past each other, or stay at their start. Only rows of
// pins that move change.
void keep_pins_apart(const ContactWorld&, std::span<const int> pins, DisjointSets& patches, const ResolveOptions&,
                     const Points& x0, Points& x1);

}  // namespace selvedge

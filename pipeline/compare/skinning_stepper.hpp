#pragma once

#include "pipeline/scene/kinds.hpp"

namespace selvedge {

// Cloth goes where the body that wears it takes it, by linear blend skinning, without forces: what every other stepper
// has to be better than. Vertices that nothing wears stay where they are. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_skinning_stepper(const Scene&);

// The program's kinds of steppers and `skinning`.
Kinds compared_kinds();

}  // namespace selvedge

#pragma once

#include <memory>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// A stepper for states of which triangles are cut out (cut_out.hpp): what is left is a scene of its own, stepped by
// what `make` makes of it, and vertices that only cut triangles have go where Drive::worn has them. At the end of each
// step the triangles that are free come back, where and as fast as they are then, and what is audited is the cloth with
// them and without what stays out. States of which nothing is cut out are stepped by `whole`, with extras. Keeps a
// reference to the scene.
std::unique_ptr<Stepper> make_cutting_stepper(const Scene&, MakeStepper make, std::unique_ptr<Stepper> whole);

}  // namespace selvedge

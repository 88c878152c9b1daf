#pragma once

#include <memory>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// A stepper for states with triangles that are cut out (cut_out.hpp). The rest is a scene of its own, stepped by the
// stepper that `make` makes of it. Vertices that only cut triangles have follow Drive::skinned_targets. At the end of
// each step the triangles that are free come back with their present positions and velocities. The audit includes them,
// and leaves out those that stay out. States without cut-out triangles are stepped by `whole`, with extras. Keeps a
// reference to the scene.
std::unique_ptr<Stepper> make_cutting_stepper(const Scene&, MakeStepper make, std::unique_ptr<Stepper> whole);

}  // namespace selvedge

#pragma once

#include <memory>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

struct CarriedOptions {
  double kept = 0.6;  // The part of the last frame's motion relative to the body that cloth keeps.
};

// Where cloth that a body wears goes without any forces: along with its skinned target, and on by a part of its last
// motion relative to that. Cloth that nothing wears falls freely. Pins are where the drive has them. n x 3 [m].
Points carried_guess(const Scene&, const State& from, const Drive&, double dt, const CarriedOptions& = {});

// What the next carried guess reads: the targets of this frame, and the motion relative to them. x: the cloth at the
// end of the step.
std::vector<MemoryBlock> carried_memory(const State& from, const Drive&, const Points& x);

// The targets that carried_memory left in the state; null: none.
const MemoryRows* carried_targets(const State&);

// The baseline that a learned stepper has to beat: the carried guess, then Bridson's response to contact. It solves
// nothing and ignores every elastic force; dressed cloth has no gravity either. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_carried_stepper(const Scene&, const CarriedOptions& = {});

}  // namespace selvedge

#pragma once

#include <span>

#include "physics/scene/stepper.hpp"
#include "pipeline/training/training_world.hpp"

namespace selvedge {

// The drive toward a body and a skinned garment. Without a body nothing wears the garment. `forces` has acceleration
// and wind.
Drive drive_to(const Scene&, const Drive& forces, const Points& body, const Points& cloth);

// Lets the solver go on from a state of the scene over the frames, one after the other: bodies and skinned garments at
// their ends. `forces` has acceleration and wind. Returns false if it rejects a step.
bool simulate_frames(Stepper&, const Scene&, const Drive& forces, std::span<const SkinnedFrame> ends, State&);

}  // namespace selvedge

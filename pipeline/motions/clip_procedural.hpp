#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/motions/clip.hpp"

namespace selvedge {

// The names of the procedural clips.
std::vector<std::string> procedural_clip_names();

// A clip by name for a body whose joints in the zero pose are given, 24 x 3 in SMPL's order [m], 30 frames a second.
// Legs follow from the places of the feet, so that every body walks without sliding; strides scale with the legs, times
// do not. `floor`: y of the soles in the zero pose; absent: 2 % of a leg's length below the lower foot joint. The clip
// begins and ends at rest. Throws Error for an unknown name or joints that are not a body's.
Clip make_clip(const std::string& name, const Points& joints, std::optional<double> floor = {});

}  // namespace selvedge

#pragma once

#include <string>

#include "pipeline/obstacles/setup_body.hpp"

namespace selvedge {

// What read_performances is made of, for bodies and clips that are in no file.

// A body in its mean shape and zero pose. Closed shells are turned outwards; `what` names the body in warnings of that.
Performance figure_of(BodyModel, const std::string& what);

// Gives it a clip of its own joints, and the room of the `body` section. Throws Error at `what` for a clip that moves
// the body absurdly far.
void perform_clip(Clip, const Config& body, const Config& what, Performance&);

// Names it, and places and moves it as its `obstacle` section says.
void place_performance(const Config& obstacle, const std::string& name, Performance&);

}  // namespace selvedge

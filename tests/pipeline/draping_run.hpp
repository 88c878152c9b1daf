#pragma once

#include "pipeline/view/view.hpp"

namespace selvedge::fake {

// A square cloth of n x n vertices and 1 m that falls on a ball, moved by position-based dynamics: not physics to
// trust, but a run that looks like one. Energies and counts are made up, smooth and different in every frame.
ViewRun draping_run(const std::string& name, int n, int frames);

}  // namespace selvedge::fake

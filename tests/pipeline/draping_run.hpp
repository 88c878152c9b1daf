#pragma once

#include "pipeline/view/view.hpp"

namespace selvedge::fake {

// A square cloth of n x n vertices and 1 m that falls on a ball by position-based dynamics. It only looks like a run:
// energies and counts are made up, smooth and different in every frame.
ViewRun draping_run(const std::string& name, int n, int frames);

}  // namespace selvedge::fake

#pragma once

#include <fmt/format.h>

#include "pipeline/scene/setup.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::fake {

// A sheet of cotton, 40 cm wide, that falls from a height [m] over the middle of a ball of 10 cm.
inline Setup sheet_over_ball(const Folder& folder, double height, int frames) {
  return read_setup(write(folder, "scene.yaml",
                          fmt::format("cloths:\n"
                                      "  - rectangle: {{size: [0.4, 0.4], resolution: 11}}\n"
                                      "    translate: [0, {}, 0]\n"
                                      "    material: cotton\n"
                                      "obstacles: [{{sphere: {{radius: 0.1}}}}]\n"
                                      "run: {{frames: {}}}\n",
                                      height, frames)));
}

}  // namespace selvedge::fake

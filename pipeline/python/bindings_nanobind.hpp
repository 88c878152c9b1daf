#pragma once

#include <nanobind/nanobind.h>

namespace selvedge {

// What the parts of the extension add to the module; what is what says the type stub, selvedge/_selvedge.pyi.
void bind_scene(nanobind::module_&);  // Scene
void bind_tools(nanobind::module_&);  // check, contours, distance, untangle, read_trajectory, read_cache, compare

}  // namespace selvedge

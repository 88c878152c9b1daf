#pragma once

#include <nanobind/nanobind.h>

namespace selvedge {

// Each adds its part of the extension to the module. selvedge/_selvedge.pyi declares all names.
void bind_scene(nanobind::module_&);  // Scene
void bind_tools(nanobind::module_&);  // check, contours, distance, untangle, read_trajectory, read_cache, compare

}  // namespace selvedge

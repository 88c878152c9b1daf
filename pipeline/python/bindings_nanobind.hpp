#pragma once

#include <nanobind/nanobind.h>

namespace selvedge {

// Each adds its part of the extension to the module. selvedge/_selvedge.pyi declares all names.
void bind_scene(nanobind::module_&);  // Scene, step
void bind_tools(nanobind::module_&);  // check, contours, distance, untangle, read_cache
void bind_runs(nanobind::module_&);   // what commands make of files: plan, fit, dataset, train, compare, export, page
void bind_trajectories(nanobind::module_&);  // what selvedge/trajectories.py reads runs with

}  // namespace selvedge

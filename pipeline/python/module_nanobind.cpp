#include "collision/geometry/error.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/python/bindings_nanobind.hpp"

NB_MODULE(_selvedge, module) {
  nanobind::exception<selvedge::Error>(module, "Error", PyExc_ValueError);
  module.attr("__version__") = selvedge::program_version();
  selvedge::bind_scene(module);
  selvedge::bind_tools(module);
  selvedge::bind_runs(module);
  selvedge::bind_trajectories(module);
}

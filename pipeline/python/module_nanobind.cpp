#include "collision/geometry/error.hpp"
#include "pipeline/host/process_threads.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/python/bindings_nanobind.hpp"

NB_MODULE(_selvedge, module) {
  if (const auto limited = selvedge::limit_threads())
    if (PyErr_WarnEx(PyExc_RuntimeWarning, limited->c_str(), 1) < 0) throw nanobind::python_error();
  nanobind::exception<selvedge::Error>(module, "Error", PyExc_ValueError);
  module.attr("__version__") = selvedge::program_version();
  selvedge::bind_scene(module);
  selvedge::bind_tools(module);
  selvedge::bind_runs(module);
  selvedge::bind_trajectories(module);
}

#include "collision/geometry/error.hpp"
#include "pipeline/python/bindings_nanobind.hpp"

NB_MODULE(_selvedge, module) {
  nanobind::exception<selvedge::Error>(module, "Error", PyExc_ValueError);
  selvedge::bind_scene(module);
  selvedge::bind_tools(module);
}

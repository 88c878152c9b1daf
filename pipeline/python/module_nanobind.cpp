#include <pthread.h>

#include <algorithm>
#include <exception>
#include <string>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "collision/geometry/error.hpp"
#include "pipeline/host/process_threads.hpp"
#include "pipeline/host/version.hpp"
#include "pipeline/python/bindings_nanobind.hpp"

namespace selvedge {
namespace {

// The argument of Python that does what a flag of the program does.
std::string argument_of(std::string flag) {
  if (flag == "set" || flag == "weights" || flag == "device") return "overrides";
  std::ranges::replace(flag, '-', '_');
  return flag;
}

// A message with arguments of Python in the place of flags. Commands, which stand between backticks, stay.
std::string for_python(const std::string& message) {
  std::string text;
  for (std::size_t i = 0; i < message.size();) {
    std::size_t end = i + 1;
    const bool begins = i == 0 || message[i - 1] == ' ' || message[i - 1] == '(' || message[i - 1] == '\n';
    if (message[i] == '`') {
      end = message.find('`', end);
      end = end == std::string::npos ? message.size() : end + 1;
    } else if (begins && message.compare(i, 2, "--") == 0) {
      end = std::min(message.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", i), message.size());
    }
    const bool flag = message[i] == '-' && end > i + 2;
    text += flag ? "`" + argument_of(message.substr(i + 2, end - i - 2)) + "`" : message.substr(i, end - i);
    i = end;
  }
  return text;
}

// Raises what `type` is, selvedge.Error, for an Error.
void raise_error(const std::exception_ptr& thrown, void* type) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    PyErr_SetString(static_cast<PyObject*>(type), for_python(error.what()).c_str());
  }
}

// Python's multiprocessing forks. The threads of OpenMP are not in the new process, which would wait for them for ever:
// they end before, and both processes start new ones when they need them.
void end_threads_at_forks() {
#ifdef _OPENMP
  pthread_atfork([] { omp_pause_resource_all(omp_pause_hard); }, nullptr, nullptr);
#endif
}

}  // namespace
}  // namespace selvedge

NB_MODULE(_selvedge, module) {
  if (const auto limited = selvedge::limit_threads())
    if (PyErr_WarnEx(PyExc_RuntimeWarning, limited->c_str(), 1) < 0) throw nanobind::python_error();
  selvedge::end_threads_at_forks();
  const nanobind::object error = nanobind::exception<selvedge::Error>(module, "Error", PyExc_ValueError);
  nanobind::register_exception_translator(selvedge::raise_error, error.ptr());
  module.attr("__version__") = selvedge::program_version();
  selvedge::bind_scene(module);
  selvedge::bind_tools(module);
  selvedge::bind_runs(module);
  selvedge::bind_trajectories(module);
}

#include "pipeline/python/python_stop_nanobind.hpp"

#include <utility>

namespace selvedge {

namespace nb = nanobind;

bool PythonStop::asked() {
  constexpr Clock::duration pause = std::chrono::milliseconds(100);
  if (raised_) return true;
  const Clock::rep now = Clock::now().time_since_epoch().count();
  Clock::rep before = asked_at_;
  if (now - before < pause.count() || !asked_at_.compare_exchange_strong(before, now)) return false;
  const nb::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) keep(nb::python_error());
  return raised_;
}

void PythonStop::keep(const nb::python_error& error) {
  if (!error_) error_.emplace(error);
  raised_ = true;
}

void PythonStop::raise_kept() const {
  if (error_) throw nb::python_error(*error_);
}

PythonLog::PythonLog(nb::object function, PythonStop& stop)
    : std::ostream(static_cast<std::streambuf*>(this)), function_(std::move(function)), stop_(stop) {}

int PythonLog::overflow(int character) {
  if (character == std::streambuf::traits_type::eof()) return 0;
  if (character != '\n') {
    line_ += static_cast<char>(character);
    return character;
  }
  const nb::gil_scoped_acquire lock;
  if (!function_.is_none()) try {
      function_(line_.c_str());
    } catch (const nb::python_error& error) {
      stop_.keep(error);
    }
  line_.clear();
  return character;
}

}  // namespace selvedge

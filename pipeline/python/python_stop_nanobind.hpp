#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <ostream>
#include <streambuf>
#include <string>

namespace selvedge {

// Ctrl-C during work that C++ does with or without Python's lock. Any thread may ask. Python looks for signals on its
// main thread alone.
class PythonStop {
 public:
  // Whether Python has raised something. Python is asked ten times a second at most.
  bool asked();
  // Keeps what Python has just raised; call with the lock.
  void keep(const nanobind::python_error&);
  // Throws what was kept, if there is any; call with the lock.
  void raise_kept() const;

 private:
  using Clock = std::chrono::steady_clock;
  std::atomic<bool> raised_ = false;
  std::atomic<Clock::rep> asked_at_ = Clock::now().time_since_epoch().count();
  std::optional<nanobind::python_error> error_;  // of the thread with the lock
};

// A stream whose lines go to a function of Python, one call each, without their ends. What the function raises is kept
// by the stop, and ends the work.
class PythonLog final : private std::streambuf, public std::ostream {
 public:
  PythonLog(nanobind::object function, PythonStop&);  // None: lines go nowhere

 private:
  int overflow(int character) override;

  nanobind::object function_;
  PythonStop& stop_;
  std::string line_;
};

}  // namespace selvedge

#pragma once

#include <nanobind/nanobind.h>

namespace selvedge {

// Does work without Python's lock, so that other threads of Python go on. It must not touch Python's objects.
template <class Work>
auto unlocked(const Work& work) {
  const nanobind::gil_scoped_release released;
  return work();
}

}  // namespace selvedge

#pragma once

namespace selvedge {

// While it lives, the first Ctrl-C (or SIGTERM) is only noted, so that a run can end with whole files; the second ends
// the program.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;
  static bool interrupted();
};

}  // namespace selvedge

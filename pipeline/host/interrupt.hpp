#pragma once

namespace selvedge {

// While it lives, the first Ctrl-C or SIGTERM is only noted, so that a run can end with whole files; the second ends
// the program. SIGHUP is noted, too, however often it comes, and stays ignored where it was.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;
  static bool interrupted();
};

}  // namespace selvedge

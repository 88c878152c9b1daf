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

// From now on a write beyond the largest size that files may have (`ulimit -f`) fails as one on a full disk does; the
// system's signal would end the program in the middle of it.
void ignore_file_limit_signal();

}  // namespace selvedge

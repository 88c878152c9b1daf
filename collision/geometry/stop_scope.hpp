#pragma once

#include <atomic>
#include <exception>
#include <thread>

#include "collision/geometry/stop_flag.hpp"

namespace selvedge {

// Thrown by a search, an audit or another loop whose stop flag has become true. The loop then has no result.
class Stopped : public std::exception {
 public:
  const char* what() const noexcept override { return "stopped"; }
};

// For the lifetime of this object, long loops of the calling thread ask this flag and throw Stopped once it is true.
// With an empty flag they do not ask. Only this thread calls the flag.
class StopScope {
 public:
  explicit StopScope(const StopFlag&);  // the flag must outlive the scope
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  const StopFlag* before_;
};

// Throws Stopped if the flag of the thread's scope is true: for loops of one thread.
void check_stop();

// check_stop for a loop that several threads share: all of them call wanted() now and then, and the thread that has
// made the poll calls check() when all are through. check() asks the flag once more, since that thread may have had no
// part of the loop.
class StopPoll {
 public:
  StopPoll();
  bool wanted() {
    if (was_wanted()) return true;
    if (!flag_ || std::this_thread::get_id() != owner_ || !(*flag_)()) return false;
    wanted_.store(true, std::memory_order_relaxed);
    return true;
  }
  bool was_wanted() const { return wanted_.load(std::memory_order_relaxed); }
  void check() {
    if (wanted()) throw Stopped();
  }

 private:
  const StopFlag* flag_;  // null: no scope, or an empty flag
  std::thread::id owner_ = std::this_thread::get_id();
  std::atomic<bool> wanted_ = false;
};

}  // namespace selvedge

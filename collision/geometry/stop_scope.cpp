#include "collision/geometry/stop_scope.hpp"

#include <utility>

namespace selvedge {
namespace {

// As the number of threads is a thread's own (parallel.hpp), so is what ends its loops.
thread_local const StopFlag* asked = nullptr;

}  // namespace

StopScope::StopScope(const StopFlag& flag) : before_(std::exchange(asked, flag ? &flag : nullptr)) {}

StopScope::~StopScope() { asked = before_; }

void check_stop() {
  if (asked && (*asked)()) throw Stopped();
}

StopPoll::StopPoll() : flag_(asked) {}

}  // namespace selvedge

#include "collision/geometry/stop_scope.hpp"

#include <utility>

namespace selvedge {
namespace {

// Each thread has a flag of its own, as it has a number of threads of its own (parallel.hpp).
thread_local const StopFlag* asked = nullptr;

}  // namespace

StopScope::StopScope(const StopFlag& flag) : before_(std::exchange(asked, flag ? &flag : nullptr)) {}

StopScope::~StopScope() { asked = before_; }

void check_stop() {
  if (asked && (*asked)()) throw Stopped();
}

StopPoll::StopPoll() : flag_(asked) {}

}  // namespace selvedge

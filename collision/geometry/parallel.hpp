#pragma once

#include <functional>

namespace selvedge {

// Calls body(i) for 0 <= i < count on all threads, `grain` calls at a time, in no order. The body must not throw.
void parallel_for(int count, int grain, const std::function<void(int)>& body);

}  // namespace selvedge

#pragma once

#include "collision/geometry/stop_flag.hpp"
#include "collision/untangle/untangle.hpp"

namespace selvedge {

// The passes of untangling that a step may take, and has taken.
struct UntanglingBudget {
  int max_passes = 1000;
  const StopFlag* stop = nullptr;  // asked in each pass
  int used = 0;
  bool ran_out = false;  // more passes were wanted

  // Untangles with at most options.iterations passes, and no more than are left. With no passes left the cloth stays.
  UntangleResult untangle(const Surface& cloth, const Points& x, std::span<const SheetView> obstacles,
                          UntangleOptions options);
};

}  // namespace selvedge

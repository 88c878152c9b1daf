#pragma once

#include "collision/geometry/stop_flag.hpp"
#include "collision/untangle/untangle.hpp"

namespace selvedge {

// What a step may spend on untangling, in passes, and what it has.
struct UntanglingBudget {
  int most = 1000;                 // passes
  const StopFlag* stop = nullptr;  // asked once a pass
  int used = 0;
  bool ran_out = false;  // where more passes were wanted

  // Untangles by at most options.iterations passes, and by no more than are left: none leaves the cloth where it is.
  UntangleResult untangle(const Surface& cloth, const Points& x, std::span<const SheetView> obstacles,
                          UntangleOptions options);
};

}  // namespace selvedge

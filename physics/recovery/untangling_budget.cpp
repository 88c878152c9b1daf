#include "physics/recovery/untangling_budget.hpp"

#include <algorithm>

namespace selvedge {

UntangleResult UntanglingBudget::untangle(const Surface& cloth, const Points& x, std::span<const SheetView> obstacles,
                                          UntangleOptions options) {
  const int left = std::max(0, max_passes - used), wanted = options.iterations;
  options.iterations = std::min(wanted, left);
  // The second rule of repulsion takes as many passes again.
  if (options.second_rule && 2 * options.iterations > left) {
    options.second_rule = left >= 2;
    options.iterations = options.second_rule ? left / 2 : left;
  }
  if (stop) options.stop = *stop;
  UntangleResult result = selvedge::untangle(cloth, x, obstacles, options);
  used += result.iterations;
  ran_out = ran_out || (options.iterations < wanted && result.pairs_after + result.vertex_pairs_after > 0);
  return result;
}

}  // namespace selvedge

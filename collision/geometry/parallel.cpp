#include "collision/geometry/parallel.hpp"

namespace selvedge {

void parallel_for(int count, [[maybe_unused]] int grain, const std::function<void(int)>& body) {
#pragma omp parallel for schedule(dynamic, grain)
  for (int i = 0; i < count; ++i) body(i);
}

}  // namespace selvedge

#include "collision/geometry/parallel.hpp"

#include "collision/geometry/stop_scope.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

namespace selvedge {

bool has_openmp() {
#ifdef _OPENMP
  return true;
#else
  return false;
#endif
}

int most_threads() {
#ifdef _OPENMP
  return omp_get_max_threads();
#else
  return 1;
#endif
}

void use_threads([[maybe_unused]] int count) {
#ifdef _OPENMP
  omp_set_num_threads(count);
#endif
}

void parallel_for(int count, [[maybe_unused]] int grain, const std::function<void(int)>& body) {
  StopPoll stop;
#pragma omp parallel for schedule(dynamic, grain)
  for (int i = 0; i < count; ++i)
    if (!stop.wanted()) body(i);
  stop.check();
}

}  // namespace selvedge

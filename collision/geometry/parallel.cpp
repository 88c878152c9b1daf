#include "collision/geometry/parallel.hpp"

#include "collision/geometry/stop_scope.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

namespace selvedge {

#ifdef _OPENMP
bool has_openmp() { return true; }
int most_threads() { return omp_get_max_threads(); }
void use_threads(int count) { omp_set_num_threads(count); }
#else
bool has_openmp() { return false; }
int most_threads() { return 1; }
void use_threads(int) {}
#endif

void parallel_for(int count, [[maybe_unused]] int grain, const std::function<void(int)>& body) {
  StopPoll stop;
#pragma omp parallel for schedule(dynamic, grain)
  for (int i = 0; i < count; ++i)
    if (!stop.wanted()) body(i);
  stop.check();
}

}  // namespace selvedge

#pragma once

#ifdef _OPENMP
#include <omp.h>
#endif

namespace selvedge::fake {

// Runs `work` with that many threads (one where the build has no OpenMP).
template <class Work>
void with_some_threads([[maybe_unused]] int threads, Work work) {
#ifdef _OPENMP
  const int before = omp_get_max_threads();
  omp_set_num_threads(threads);
  work();
  omp_set_num_threads(before);
#else
  work();
#endif
}

}  // namespace selvedge::fake

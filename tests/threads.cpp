#include "tests/threads.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

namespace selvedge {

int most_threads() {
#ifdef _OPENMP
  return omp_get_max_threads();
#else
  return 1;
#endif
}

void with_threads([[maybe_unused]] int threads, const std::function<void()>& work) {
#ifdef _OPENMP
  const int before = omp_get_max_threads();
  omp_set_num_threads(threads);
  work();
  omp_set_num_threads(before);
#else
  work();
#endif
}

}  // namespace selvedge

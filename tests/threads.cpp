#include "tests/threads.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

namespace selvedge {

void with_threads([[maybe_unused]] int threads, const std::function<void()>& work) {
#ifdef _OPENMP
  const int before = most_threads();
  omp_set_num_threads(threads);
  work();
  omp_set_num_threads(before);
#else
  work();
#endif
}

}  // namespace selvedge

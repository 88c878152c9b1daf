#pragma once

#include <cstring>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "collision/geometry/points.hpp"

namespace selvedge {

// Runs `work` with that many threads (one where the build has no OpenMP).
template <class Work>
void with_threads([[maybe_unused]] int threads, Work work) {
#ifdef _OPENMP
  const int before = omp_get_max_threads();
  omp_set_num_threads(threads);
  work();
  omp_set_num_threads(before);
#else
  work();
#endif
}

inline bool same_bits(const Points& a, const Points& b) {
  return a.rows() == b.rows() && std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
}

}  // namespace selvedge

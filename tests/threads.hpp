#pragma once

#include <cstring>
#include <functional>

#include "collision/geometry/parallel.hpp"
#include "collision/geometry/points.hpp"

namespace selvedge {

// Runs `work` with that many threads (one if the build has no OpenMP).
inline void with_threads(int threads, const std::function<void()>& work) {
  const ThreadLimit limit(threads);
  work();
}

inline bool same_bits(const Points& a, const Points& b) {
  return a.rows() == b.rows() && std::memcmp(a.data(), b.data(), sizeof(double) * a.size()) == 0;
}

}  // namespace selvedge

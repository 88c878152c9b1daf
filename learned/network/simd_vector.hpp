#pragma once

#include <cstring>

// For files of inner loops only. They are templates over the number of lanes, inlined into one function per instruction
// set, so that no function takes a vector.

#if defined(__x86_64__)
#define SELVEDGE_TARGET(set) __attribute__((target(set)))
#else
#define SELVEDGE_TARGET(set)
#endif

// For loops over the rows of a block, whose sums stay in registers only if the loop is unrolled.
#if defined(__clang__)
#define SELVEDGE_UNROLL _Pragma("unroll")
#else
#define SELVEDGE_UNROLL _Pragma("GCC unroll 16")
#endif

namespace selvedge {

template <int Lanes>
struct Simd {
  typedef float Vector __attribute__((vector_size(4 * Lanes)));
  typedef float Anywhere __attribute__((vector_size(4 * Lanes), aligned(4), may_alias));
};

template <int Lanes>
using Vector = typename Simd<Lanes>::Vector;

template <int Lanes>
[[gnu::always_inline]] inline Vector<Lanes> load_vector(const float* from) {
  return *reinterpret_cast<const typename Simd<Lanes>::Anywhere*>(from);
}

template <int Lanes>
[[gnu::always_inline]] inline void store_vector(Vector<Lanes> vector, float* to) {
  *reinterpret_cast<typename Simd<Lanes>::Anywhere*>(to) = vector;
}

template <int Lanes>
[[gnu::always_inline]] inline float sum_lanes(Vector<Lanes> vector) {
  float sums[Lanes];
  std::memcpy(sums, &vector, sizeof sums);
  SELVEDGE_UNROLL
  for (int half = Lanes / 2; half > 0; half /= 2)
    for (int i = 0; i < half; ++i) sums[i] += sums[i + half];
  return sums[0];
}

}  // namespace selvedge

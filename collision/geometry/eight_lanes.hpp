#pragma once

namespace selvedge {

// Eight numbers side by side, for kernels that are compiled with and without AVX2 and give the same bits with both.
// Without AVX gcc would align these types to 16 bytes, but the code for AVX2 relies on 32.
using Eight [[gnu::vector_size(32), gnu::aligned(32)]] = float;
using EightBits [[gnu::vector_size(32), gnu::aligned(32)]] = int;  // all bits of a lane, or none
struct EightVec3 {
  Eight x, y, z;
};

[[gnu::always_inline]] inline Eight smaller(const Eight& a, const Eight& b) { return a < b ? a : b; }
[[gnu::always_inline]] inline Eight larger(const Eight& a, const Eight& b) { return a > b ? a : b; }
[[gnu::always_inline]] inline EightVec3 minus(const EightVec3& a, const EightVec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[gnu::always_inline]] inline Eight dot(const EightVec3& a, const EightVec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[gnu::always_inline]] inline EightVec3 cross(const EightVec3& a, const EightVec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// One bit for each lane, without and with AVX2.
inline unsigned bits_plain(const EightBits& flags) {
  unsigned bits = 0;
  for (int i = 0; i < 8; ++i) bits |= static_cast<unsigned>(flags[i] & (1 << i));
  return bits;
}
#if defined(__x86_64__)
[[gnu::target("avx2")]] inline unsigned bits_avx2(const EightBits& flags) {
  return static_cast<unsigned>(__builtin_ia32_movmskps256(reinterpret_cast<Eight>(flags)));
}
#endif

// Does the processor have AVX2?
inline bool has_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

}  // namespace selvedge

#pragma once

#include <cstdint>

namespace selvedge {

// The next random number of a state, the same on every machine: splitmix64 (Steele et al. 2014).
inline std::uint64_t splitmix64(std::uint64_t& state) {
  std::uint64_t z = state += 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

// Random numbers of 24 bits each.
class UniformNumbers {
 public:
  explicit UniformNumbers(std::uint64_t seed) : state_(seed) {}
  float in_both_signs() { return static_cast<float>(next()) / 8388608.f - 1.f; }  // in [-1, 1)
  double in_unit() { return (static_cast<double>(next()) + 0.5) / 16777216.0; }   // in (0, 1)

 private:
  std::uint64_t next() { return splitmix64(state_) >> 40; }
  std::uint64_t state_;
};

}  // namespace selvedge

#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "learned/network/uniform_numbers.hpp"

namespace selvedge {

// Random numbers with one number as the whole state (splitmix64).
struct RandomStream {
  std::uint64_t state = 0;

  std::uint64_t next() { return splitmix64(state); }
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }  // [0, 1)
  double between(double low, double high) { return low + (high - low) * uniform(); }
  int below(int count) { return static_cast<int>(uniform() * count); }  // 0 to count - 1
  bool heads(double share) { return uniform() < share; }
  double normal() {  // Box and Muller 1958, one of the pair
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
};

// A separate stream for each number, independent of earlier draws.
inline RandomStream stream_of(std::uint64_t seed, std::uint64_t number) {
  RandomStream mixed{seed * 0xD1342543DE82EF95 + number};
  return RandomStream{mixed.next()};
}

}  // namespace selvedge

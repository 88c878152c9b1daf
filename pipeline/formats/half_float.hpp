#pragma once

#include <cmath>
#include <cstdint>

namespace selvedge {

// The number that 16 bits stand for, by binary16 of IEEE 754.
inline double half_value(std::uint16_t word) {
  const int exponent = word >> 10 & 31, digits = word & 1023;
  const double size = exponent == 31 ? (digits ? NAN : INFINITY)
                                     : std::ldexp(exponent ? 1024 + digits : digits, (exponent ? exponent : 1) - 25);
  return word >> 15 ? -size : size;
}

}  // namespace selvedge

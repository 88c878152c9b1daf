#pragma once

#include <string>

namespace selvedge {

// The word of a sentence that goes with a number: `one` with 1, `many` with any other.
inline std::string by_number(long long n, const std::string& one, const std::string& many) {
  return n == 1 ? one : many;
}

// "1 frame", "2 frames". `many` is for nouns whose plural is not the noun with an s.
inline std::string counted(long long n, const std::string& one, const std::string& many = "") {
  return std::to_string(n) + " " + by_number(n, one, many.empty() ? one + "s" : many);
}

}  // namespace selvedge

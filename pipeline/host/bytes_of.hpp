#pragma once

#include <cstddef>
#include <string_view>

namespace selvedge {

// The bytes of a matrix, a vector or a span that stands as it is: for hashes and files.
template <class Numbers>
std::string_view bytes_of(const Numbers& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()),
          sizeof(*numbers.data()) * static_cast<std::size_t>(numbers.size())};
}

}  // namespace selvedge

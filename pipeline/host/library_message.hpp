#pragma once

#include <string>

namespace selvedge {

// What a library says of a file, in words alone: without the names of its exceptions, which stand in brackets.
inline std::string library_message(std::string text) {
  for (std::size_t begin; (begin = text.find("[json.exception.")) != std::string::npos;) {
    const std::size_t end = text.find("] ", begin);
    text.erase(begin, end == std::string::npos ? end : end + 2 - begin);
  }
  return text;
}

}  // namespace selvedge

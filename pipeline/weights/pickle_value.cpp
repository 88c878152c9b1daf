#include "pipeline/weights/pickle_value.hpp"

namespace selvedge {

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 120;
  std::string line;
  for (const char c : text.substr(0, longest)) line += c >= ' ' && c <= '~' ? std::string(1, c) : "?";
  return text.size() > longest ? line + ".." : line;
}

}  // namespace selvedge

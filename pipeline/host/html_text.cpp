#include "pipeline/host/html_text.hpp"

#include <map>

#include <fmt/format.h>

namespace selvedge {
namespace {

bool stands_for_itself(char c) {
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  return letter || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.' || c == '~';
}

}  // namespace

std::string html_text(const std::string& text) {
  static const std::map<char, std::string> escapes{
      {'<', "&lt;"}, {'>', "&gt;"}, {'&', "&amp;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  std::string result;
  for (const char c : text) {
    const auto escape = escapes.find(c);
    result += escape == escapes.end() ? std::string(1, c) : escape->second;
  }
  return result;
}

std::string url_text(const std::string& text) {
  std::string result;
  for (const char c : text)
    result += stands_for_itself(c) ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return result;
}

}  // namespace selvedge

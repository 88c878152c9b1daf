#pragma once

#include <stdexcept>
#include <string>

namespace selvedge {

// The text with \0 in place of each NUL byte, at which a message would end.
inline std::string without_nul(std::string text) {
  for (std::size_t at = 0; (at = text.find('\0', at)) != std::string::npos;) text.replace(at, 1, "\\0");
  return text;
}

// Bad input or a missing package. Says what is wrong, where, and how to cure it; caught once, in main.
class Error : public std::runtime_error {
 public:
  Error(std::string what, std::string where, std::string cure)
      : std::runtime_error(without_nul(where + ": " + what + (cure.empty() ? "" : "\n  cure: " + cure))),
        what_(without_nul(std::move(what))),
        where_(without_nul(std::move(where))),
        cure_(without_nul(std::move(cure))) {}

  const std::string& problem() const { return what_; }
  const std::string& where() const { return where_; }
  const std::string& cure() const { return cure_; }

 private:
  std::string what_, where_, cure_;
};

// What `read` returns. Where it throws Error, `whose` stands before the place: the file that asked for it, for example.
template <class Read>
auto read_for(const std::string& whose, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    throw Error(error.problem(), whose + ": " + error.where(), error.cure());
  }
}

}  // namespace selvedge

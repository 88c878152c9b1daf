#pragma once

#include <stdexcept>
#include <string>

namespace selvedge {

// Bad input or a missing package. Says what is wrong, where, and how to cure it; caught once, in main.
class Error : public std::runtime_error {
 public:
  Error(std::string what, std::string where, std::string cure)
      : std::runtime_error(where + ": " + what + (cure.empty() ? "" : "\n  cure: " + cure)),
        what_(std::move(what)),
        where_(std::move(where)),
        cure_(std::move(cure)) {}

  const std::string& problem() const { return what_; }
  const std::string& where() const { return where_; }
  const std::string& cure() const { return cure_; }

 private:
  std::string what_, where_, cure_;
};

}  // namespace selvedge

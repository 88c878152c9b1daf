#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace selvedge {

// While it lives, other processes of this user see that a training runs (running_training). It ends with the process,
// however that ends. Where another training runs already, `other` says which.
class RunningMark {
 public:
  explicit RunningMark(const std::filesystem::path& configuration);
  ~RunningMark();
  RunningMark(const RunningMark&) = delete;
  RunningMark& operator=(const RunningMark&) = delete;
  const std::optional<std::string>& other() const { return other_; }

 private:
  int file_ = -1;
  std::optional<std::string> other_;
};

// The configuration of a training that runs on this machine now, for commands that take times; nothing: none does.
std::optional<std::string> running_training();

}  // namespace selvedge

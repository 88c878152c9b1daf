#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace selvedge {

// While it exists, other processes of this user see that a training runs (running_training). It ends with the process,
// even after a crash. If another training runs already, `other` names it.
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

// The configuration of a training that runs on this machine now, for commands that measure times. Empty: none runs.
std::optional<std::string> running_training();

}  // namespace selvedge

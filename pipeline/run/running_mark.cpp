#include "pipeline/run/running_mark.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "pipeline/host/kept_rows.hpp"
#include "pipeline/obstacles/setup_paths.hpp"

namespace selvedge {
namespace {

std::filesystem::path mark_path() { return cache_folder() / "training-running"; }

}  // namespace

// A lock on a file, which the system releases when the process ends.
RunningMark::RunningMark(const std::filesystem::path& configuration) {
  if (cache_folder().empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(cache_folder(), ignored);
  file_ = open(mark_path().c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0644);
  if (file_ < 0) return;
  if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    other_ = whole_file(mark_path());
    close(file_);
    file_ = -1;
    return;
  }
  const std::string text = std::filesystem::absolute(configuration).string();
  if (ftruncate(file_, 0) != 0 || write(file_, text.data(), text.size()) < 0) {
    // Other processes then see a training without its file.
  }
}

RunningMark::~RunningMark() {
  if (file_ >= 0) close(file_);
}

std::optional<std::string> running_training() {
  if (cache_folder().empty()) return std::nullopt;
  const int file = open(mark_path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) return std::nullopt;
  const bool free = flock(file, LOCK_SH | LOCK_NB) == 0;
  close(file);
  if (free) return std::nullopt;
  return whole_file(mark_path());
}

}  // namespace selvedge

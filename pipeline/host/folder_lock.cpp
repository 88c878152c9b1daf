#include "pipeline/host/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

std::string holder_of(int descriptor) {
  std::array<char, 32> text{};
  const ssize_t length = ::pread(descriptor, text.data(), text.size() - 1, 0);
  return length > 0 ? std::string(text.data(), static_cast<std::size_t>(length)) : "unknown";
}

// Whether the path still names the open file: who held it before may have removed it since.
bool is_named(int descriptor, const std::filesystem::path& path) {
  struct stat open = {}, named = {};
  return ::fstat(descriptor, &open) == 0 && ::lstat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

// Whether what is written there is in no other file: a plain file of one name.
bool is_own(int descriptor) {
  struct stat open = {};
  return ::fstat(descriptor, &open) == 0 && S_ISREG(open.st_mode) && open.st_nlink <= 1;
}

[[noreturn]] void refuse(const std::filesystem::path& lock) {
  throw Error("is a link or no plain file, and what it leads to would be overwritten", lock.string(),
              "remove it, or choose another --out");
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : file_(folder / "run.lock") {
  for (;;) {
    const int descriptor = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0644);
    if (descriptor < 0 && errno == ELOOP) refuse(file_);
    if (descriptor < 0) return;  // what cannot be written fails where it is written, with its reason
    if (!is_own(descriptor)) {
      ::close(descriptor);
      refuse(file_);
    }
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const bool held = errno == EWOULDBLOCK;
      const std::string holder = holder_of(descriptor);
      ::close(descriptor);
      if (!held) return;
      throw Error("another run writes into this folder: process " + holder, folder.string(),
                  "wait for it or end it, or choose another --out");
    }
    if (is_named(descriptor, file_)) {
      descriptor_ = descriptor;
      break;
    }
    ::close(descriptor);
  }
  const std::string own = std::to_string(::getpid());
  if (::ftruncate(descriptor_, 0) != 0 || ::pwrite(descriptor_, own.data(), own.size(), 0) < 0) return;
}

FolderLock::~FolderLock() {
  if (descriptor_ < 0) return;
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace selvedge

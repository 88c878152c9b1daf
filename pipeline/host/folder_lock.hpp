#pragma once

#include <filesystem>

namespace selvedge {

// One process at a time writes a run into a folder. The system lets go of the lock when the process ends, however it
// does; a file `run.lock` with the process's id is there while it is held. Where the file system knows no locks,
// nothing is locked.
class FolderLock {
 public:
  // Throws Error, naming the process, where another one holds the folder, which must exist, and where `run.lock` is a
  // link or no plain file.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;  // -1: nothing is locked
};

}  // namespace selvedge

#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace selvedge {

// Where an archive's directory says that an entry is.
struct StoredEntry {
  std::uint64_t header_at = 0, size = 0;
  std::uint32_t checksum = 0;
};

// A ZIP archive of entries that are not compressed, as torch.save writes it; ZIP64 included. It has a reader of its own
// because every size is checked before anything is allocated: the directory has at most 16 MiB and 100,000 entries, an
// entry 256 MiB, and all that one archive object reads 1 GiB. A compressed or encrypted entry is an Error, so that no
// entry is larger than the file. Layout: APPNOTE.TXT of PKWARE, sections 4.3 to 4.5.
class StoredArchive {
 public:
  explicit StoredArchive(const std::filesystem::path&);  // throws Error for what cannot be opened or is no such archive

  std::vector<std::string> names() const;  // sorted
  bool has(const std::string& name) const { return entries_.contains(name); }

  // Content of an entry, its checksum compared. Throws Error, naming file and entry, also for one that is missing.
  std::string bytes(const std::string& name);

 private:
  [[noreturn]] void fail(const std::string& what) const;
  std::string read(std::uint64_t at, std::uint64_t count);
  void read_directory(const std::string& directory, std::uint64_t count);

  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t size_ = 0, directory_at_ = 0, read_ = 0;
  std::map<std::string, StoredEntry> entries_;
};

}  // namespace selvedge

#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace selvedge {

// The whole number of `count` bytes from `at` on, the lowest byte first. They must be there.
std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t count);

// The place of an entry by the archive's directory.
struct StoredEntry {
  std::uint64_t header_at = 0, size = 0;
  std::uint32_t checksum = 0;
};

// A ZIP archive of uncompressed entries, as torch.save writes it, including ZIP64. This reader checks every size before
// it allocates memory: the directory has at most 16 MiB and 100,000 entries, an entry 256 MiB, and all reads of one
// object together 1 GiB. Compressed and encrypted entries are refused, so that no entry is larger than the file.
// Layout: APPNOTE.TXT of PKWARE, sections 4.3 to 4.5.
class StoredArchive {
 public:
  explicit StoredArchive(const std::filesystem::path&);  // throws Error for a file that is no such archive

  std::vector<std::string> names() const;  // sorted
  bool has(const std::string& name) const { return entries_.contains(name); }

  // The content of an entry, after a test of its checksum. Throws Error, which names file and entry, also if it is
  // missing.
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

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace selvedge {

// What a ZIP archive holds, for messages, and what it may hold.
struct ZipForm {
  std::string noun;      // of the file: ".npz"
  std::string if_none;   // cure for a file that is no archive
  std::string how_made;  // cure for an entry of another kind
  bool compressed;       // whether entries may be compressed, by deflate
  std::int64_t most;     // bytes of an entry
  bool consistent;       // whether what stands before each entry must say what the directory says
};

// A ZIP archive, by libzip. Sizes that it claims are compared with the file's before memory is taken. Throws Error for
// what cannot be opened, is damaged, encrypted or compressed by another method, and for two entries of one name.
class ZipArchive {
 public:
  ZipArchive(const std::filesystem::path&, const ZipForm&);
  ZipArchive(ZipArchive&&) noexcept;
  ~ZipArchive();

  const std::vector<std::string>& names() const { return names_; }  // in the order of the file
  bool has(const std::string& name) const;

  // The content of an entry that the archive has, after a test of its checksum. `where` names it in an Error.
  std::string bytes(const std::string& name, const std::string& where) const;

 private:
  struct Opened;

  ZipForm form_;
  std::unique_ptr<Opened> opened_;
  std::vector<std::string> names_;
};

}  // namespace selvedge

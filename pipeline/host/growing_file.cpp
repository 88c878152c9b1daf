#include "pipeline/host/growing_file.hpp"

#include <cerrno>
#include <system_error>

#include "collision/geometry/error.hpp"
#include "collision/geometry/path_beside.hpp"
#include "pipeline/host/cure_to_write.hpp"

namespace selvedge {

GrowingFile::GrowingFile(const std::filesystem::path& path)
    : path_(path), beside_(path_beside(path)), stream_(std::fopen(beside_.c_str(), "wbxe"), std::fclose) {
  if (!stream_) failed_ = errno;
}

GrowingFile::~GrowingFile() {
  if (kept_ || failed_ == EEXIST) return;
  stream_.reset();
  std::error_code ignored;
  std::filesystem::remove(beside_, ignored);
}

void GrowingFile::write(std::string_view content) {
  if (stream_ && failed_ == 0 && std::fwrite(content.data(), 1, content.size(), stream_.get()) != content.size())
    failed_ = errno;
}

void GrowingFile::keep() {
  if (stream_ && std::fclose(stream_.release()) != 0 && failed_ == 0) failed_ = errno;
  std::error_code error(failed_, std::generic_category());
  if (!error) std::filesystem::rename(beside_, path_, error);
  if (error) throw Error("cannot write (" + error.message() + ")", path_.string(), cure_to_write(error.message()));
  kept_ = true;
}

}  // namespace selvedge

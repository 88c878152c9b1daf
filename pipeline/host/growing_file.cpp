#include "pipeline/host/growing_file.hpp"

#include <cerrno>
#include <system_error>

#include "collision/geometry/error.hpp"

namespace selvedge {

GrowingFile::GrowingFile(const std::filesystem::path& path) : path_(path), beside_(path) {
  beside_ += ".part";
  stream_.open(beside_, std::ios::binary | std::ios::trunc);
}

GrowingFile::~GrowingFile() {
  if (kept_) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(beside_, ignored);
}

void GrowingFile::write(std::string_view content) {
  stream_.write(content.data(), static_cast<std::streamsize>(content.size()));
}

void GrowingFile::keep() {
  std::error_code error;
  stream_.flush();
  if (!stream_) error = std::error_code(errno, std::generic_category());
  stream_.close();
  if (!error) std::filesystem::rename(beside_, path_, error);
  if (error)
    throw Error("cannot write (" + error.message() + ")", path_.string(),
                "check that the folder is there and may be written, and that its disk is not full");
  kept_ = true;
}

}  // namespace selvedge

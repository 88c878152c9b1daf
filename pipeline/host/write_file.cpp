#include "pipeline/host/write_file.hpp"

#include <fstream>
#include <system_error>

#include "collision/geometry/error.hpp"

namespace selvedge {

void write_file(const std::filesystem::path& path, const std::string& content) {
  std::filesystem::path beside = path;
  beside += ".part";
  std::error_code error;
  {
    std::ofstream stream(beside, std::ios::binary | std::ios::trunc);
    stream << content;
    stream.flush();
    if (!stream) error = std::error_code(errno, std::generic_category());
  }
  if (!error) std::filesystem::rename(beside, path, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(beside, ignored);
  throw Error("cannot write (" + error.message() + ")", path.string(),
              "check that the folder is there and may be written, and that its disk is not full");
}

void make_folder(const std::filesystem::path& path, const std::string& cure) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw Error("cannot make this folder (" + error.message() + ")", path.string(), cure);
}

void write_cached(const std::filesystem::path& file, const std::function<void()>& write) {
  const std::string cure =
      "set XDG_CACHE_HOME to a folder that may be written; bodies and garments by code are kept there";
  make_folder(file.parent_path(), cure);
  try {
    write();
  } catch (const Error& error) {
    throw Error(error.problem(), error.where(), cure);
  }
}

}  // namespace selvedge

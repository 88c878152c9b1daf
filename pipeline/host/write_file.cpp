#include "pipeline/host/write_file.hpp"

#include <system_error>

#include "collision/geometry/error.hpp"
#include "pipeline/host/cure_to_write.hpp"
#include "pipeline/host/growing_file.hpp"

namespace selvedge {

void write_file(const std::filesystem::path& path, const std::string& content) {
  GrowingFile file(path);
  file.write(content);
  file.keep();
}

void make_folder(const std::filesystem::path& path, const std::string& cure) {
  if (path.empty()) throw Error("has an empty name", "the folder to write to", "name it; `.` is the present folder");
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!error) return;
  throw Error("cannot make this folder (" + error.message() + ")", path.string(),
              cure == write_cure ? cure_to_write(error.message()) : cure);
}

void remove_file(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) throw Error("cannot be removed (" + error.message() + ")", path.string(), write_cure);
}

void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) throw Error("cannot write (" + error.message() + ")", to.string(), write_cure);
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

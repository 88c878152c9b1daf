#include "pipeline/obstacles/setup_paths.hpp"

#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

namespace selvedge {

namespace fs = std::filesystem;

namespace {

// Whether other users may put files into the folder.
bool is_shared(const fs::path& folder) {
  struct stat found = {};
  if (::stat(folder.c_str(), &found) != 0) return false;
  return found.st_uid != ::geteuid() || (found.st_mode & S_IWOTH) != 0;
}

std::string variable(const Config& at, const std::string& name) {
  if (const char* value = std::getenv(name.c_str()); value && *value) return value;
  if (name == "SELVEDGE_DATA") return (fs::path(SELVEDGE_SOURCE_DIR) / ".." / "shared" / "data").lexically_normal();
  at.fail("uses ${" + name + "}, which the environment does not set", "set it, or write the path out");
}

}  // namespace

fs::path config_folder() {
  std::error_code problem;
  const fs::path program = fs::read_symlink("/proc/self/exe", problem);
  const fs::path installed = program.parent_path().parent_path() / "share" / "selvedge" / "configs";
  if (!problem && fs::is_directory(installed, problem)) return installed;
  Dl_info loaded;  // the file that this code is in
  if (dladdr(reinterpret_cast<void*>(&config_folder), &loaded) != 0 && loaded.dli_fname) {
    const fs::path beside = fs::path(loaded.dli_fname).parent_path() / "configs";
    if (fs::is_directory(beside, problem)) return beside;
  }
  return fs::path(SELVEDGE_SOURCE_DIR) / "configs";
}

std::vector<fs::path> config_folders(const fs::path& folder) { return {folder, folder / "..", config_folder()}; }

fs::path config_near(const fs::path& folder, const std::string& name) {
  std::error_code ignored;
  for (const fs::path& place : config_folders(folder))
    if (fs::exists(place / name, ignored)) return place / name;
  return config_folder() / name;
}

fs::path files_folder(const Config& scene, const fs::path& file) {
  const Config& folder = scene["folder"];
  if (!folder.given) return file.parent_path();
  const fs::path place = file.parent_path() / folder.text();
  std::error_code ignored;
  if (!fs::is_directory(place, ignored))
    folder.fail("names the missing folder " + place.string(), "put the scene's folder back, or give its new place");
  return place;
}

fs::path cache_folder() {
  for (const auto& [name, below] : {std::pair{"XDG_CACHE_HOME", ""}, std::pair{"HOME", ".cache"}})
    if (const char* value = std::getenv(name); value && *value) {
      const fs::path folder = fs::path(value) / below / "selvedge";
      return is_shared(folder) ? fs::path() : folder;
    }
  return {};
}

fs::path expanded_path(const Config& at, const std::string& text, const fs::path& folder) {
  std::string result = text;
  for (std::size_t begin = 0; (begin = result.find("${", begin)) != std::string::npos;) {
    const std::size_t end = result.find('}', begin);
    if (end == std::string::npos) at.fail("has ${ without }", "write ${NAME}");
    const std::string value = variable(at, result.substr(begin + 2, end - begin - 2));
    result.replace(begin, end + 1 - begin, value);
    begin += value.size();
  }
  const fs::path path(result);
  return path.is_absolute() ? path : folder / path;
}

namespace {

// What helps where paths of a scene file lead nowhere.
std::string scene_cure(const Config& at, const std::string& text) {
  std::error_code ignored;
  const fs::path scene = at.where.substr(0, at.where.rfind(':'));  // without the line
  const std::string plain = "paths are relative to the scene file";
  if (!fs::is_symlink(scene, ignored)) return plain;
  const fs::path place = fs::canonical(scene, ignored).parent_path(), there = expanded_path(at, text, place);
  return plain + ", which is a link here" +
         (fs::exists(there, ignored) ? "; " + there.string() + " is there: give `folder: " + place.string() + "`" : "");
}

}  // namespace

fs::path existing_path(const Config& at, const std::string& text, const fs::path& folder) {
  const fs::path path = expanded_path(at, text, folder);
  std::error_code ignored;
  const bool of_option = at.where.starts_with("--") && !at.where.starts_with("--set ");
  if (!fs::exists(path, ignored))
    at.fail("names the missing file " + path.string(), text.find("SELVEDGE_DATA") != std::string::npos
                                                           ? "set SELVEDGE_DATA to the folder of the data"
                                                       : of_option ? "check the path"
                                                                   : scene_cure(at, text));
  return path;
}

fs::path existing_path(const Config& value, const fs::path& folder) {
  return existing_path(value, value.text(), folder);
}

}  // namespace selvedge

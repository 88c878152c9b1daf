#include "collision/geometry/shared_library.hpp"

#include <dlfcn.h>

#include "collision/geometry/error.hpp"
#include "collision/geometry/floating_point.hpp"

namespace selvedge {

std::filesystem::path library_beside_program(const std::string& name) {
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  return (failed ? std::filesystem::path(".") : program.parent_path()) / name;
}

void* entry_of_library(const std::filesystem::path& library, const char* entry, const std::string& noun,
                       const std::string& cure, bool global) {
  void* loaded = dlopen(library.c_str(), RTLD_NOW | (global ? RTLD_GLOBAL : RTLD_LOCAL));
  restore_standard_arithmetic();  // a library may switch denormals off as it is loaded
  if (loaded) return dlsym(loaded, entry);
  const char* reason = dlerror();
  throw Error(noun + "'s part cannot be loaded: " + std::string(reason ? reason : ""), library.string(), cure);
}

}  // namespace selvedge

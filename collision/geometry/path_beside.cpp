#include "collision/geometry/path_beside.hpp"

#include <cstdint>
#include <cstdio>
#include <random>

namespace selvedge {

std::filesystem::path path_beside(const std::filesystem::path& path) {
  std::random_device random;
  char end[32];
  std::snprintf(end, sizeof end, ".%08x%08x.part", static_cast<std::uint32_t>(random()),
                static_cast<std::uint32_t>(random()));
  std::filesystem::path beside = path;
  return beside += end;
}

}  // namespace selvedge

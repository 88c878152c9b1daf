#include "collision/geometry/path_beside.hpp"

#include <cstdint>
#include <cstdio>
#include <random>
#include <string>

namespace selvedge {

std::filesystem::path path_beside(const std::filesystem::path& path) {
  std::random_device random;
  char end[32];
  std::snprintf(end, sizeof end, ".%08x%08x.part", static_cast<std::uint32_t>(random()),
                static_cast<std::uint32_t>(random()));
  std::filesystem::path beside = path;
  return beside += end;
}

std::filesystem::path path_in_place(const std::filesystem::path& path) {
  constexpr std::size_t digits = 16;
  if (path.extension() != ".part") return path;
  const std::filesystem::path inner = path.stem();
  const std::string number = inner.extension().string();
  const bool made_here = number.size() == digits + 1 && number.find_first_not_of("0123456789abcdef", 1) == number.npos;
  return made_here ? path.parent_path() / inner.stem() : path;
}

}  // namespace selvedge

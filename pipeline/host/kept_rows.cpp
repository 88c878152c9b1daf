#include "pipeline/host/kept_rows.hpp"

#include <dlfcn.h>
#include <link.h>

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <vector>

namespace selvedge {

std::string whole_file(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::uint64_t hash_of(std::string_view text, std::uint64_t before) {
  for (const char c : text) before = (before ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return before;
}

std::uint64_t hash_of_file(const std::filesystem::path& path) {
  std::uint64_t hash = hash_of("");
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return hash;
  std::ifstream in(path, std::ios::binary);
  std::vector<char> part(1 << 20);
  while (in.read(part.data(), std::ssize(part)) || in.gcount() > 0)
    hash = hash_of({part.data(), static_cast<std::size_t>(in.gcount())}, hash);
  return hash;
}

std::string program_key() {
  Dl_info found = {};
  link_map* loaded = nullptr;  // its name is empty for the program itself
  dladdr1(reinterpret_cast<void*>(&program_key), &found, reinterpret_cast<void**>(&loaded), RTLD_DL_LINKMAP);
  const bool extension = loaded && loaded->l_name && *loaded->l_name;
  return fmt::format("{:016x}", hash_of_file(extension ? loaded->l_name : "/proc/self/exe"));
}

}  // namespace selvedge

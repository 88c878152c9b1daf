#include "learned/network/weight_seal.hpp"

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <vector>

#include "collision/geometry/error.hpp"
#include "collision/geometry/path_beside.hpp"
#include "collision/geometry/require_file.hpp"

namespace selvedge {
namespace {

constexpr const char* seal_name = "selvedge weights 1";

std::string seal_text(std::uint64_t checksum, long long length) {
  char text[96];
  std::snprintf(text, sizeof text, "%s %016llx %lld\n", seal_name, static_cast<unsigned long long>(checksum), length);
  std::string padded = text;
  padded.resize(seal_bytes, '\0');
  return padded;
}

// The seal that the bytes after it should have.
std::string wanted_seal(std::istream& file, long long& length) {
  file.seekg(seal_bytes);
  std::vector<char> bytes(1 << 20);
  std::uint64_t checksum = 0xcbf29ce484222325u;
  length = 0;
  while (file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())), file.gcount() > 0) {
    for (std::streamsize i = 0; i < file.gcount(); ++i)
      checksum = (checksum ^ static_cast<unsigned char>(bytes[static_cast<std::size_t>(i)])) * 0x100000001b3u;
    length += file.gcount();
  }
  return seal_text(checksum, length);
}

}  // namespace

void write_seal(const std::filesystem::path& path) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  long long length = 0;
  const std::string seal = wanted_seal(file, length);
  file.clear();
  file.seekp(0);
  file.write(seal.data(), seal_bytes).flush();
  if (!file) throw Error("cannot write the checksum", path_in_place(path).string(), write_cure);
}

long long check_seal(const std::filesystem::path& path) {
  require_file(path, "weight");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error("cannot open", path.string(), "check the path");
  std::string seal(seal_bytes, '\0');
  file.read(seal.data(), seal_bytes);
  if (!file || !seal.starts_with(seal_name))
    throw Error("holds no weights of a network that a stepper runs", path.string(),
                "give weights.h5 or best.h5 of `selvedge train`, or what `selvedge weights import` made of a published "
                "checkpoint (.pth); scales of the repulsive layer belong to run.refu.weights");
  long long length = 0;
  if (wanted_seal(file, length) != seal)
    throw Error("its bytes do not fit its checksum", path.string(), "the file is damaged: copy or make it again");
  return length;
}

}  // namespace selvedge

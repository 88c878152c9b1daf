#pragma once

#include <fstream>
#include <iterator>

#include "tests/fuzz/altered_hdf5.hpp"
#include "tests/fuzz/fuzzed_file.hpp"

namespace selvedge::fuzz {

// Calls `read` with a changed copy of the valid file that `write` writes. Fields are altered, or, if
// SELVEDGE_FUZZ_DAMAGE is set, bytes of the file, which can crash HDF5 itself.
template <class Write, class Read>
int with_altered_file(const std::uint8_t* data, std::size_t size, const Write& write, const Read& read) {
  static const std::filesystem::path path = path_of(".h5");
  static const AlteredHdf5 altered = [&] {
    write(path);
    return AlteredHdf5(path);
  }();
  static const bool damages = std::getenv("SELVEDGE_FUZZ_DAMAGE") != nullptr;
  if (!damages) {
    altered.write(data, size, path);
    return read_or_refuse([&] { read(path); });
  }
  static const std::string valid = [] {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }();
  std::string bytes = valid;
  for (std::size_t k = 0; k + 4 <= size && k < 64; k += 4)
    bytes[(data[k] << 16 | data[k + 1] << 8 | data[k + 2]) % bytes.size()] = static_cast<char>(data[k + 3]);
  return read_or_refuse([&] { read(file_of(".h5", bytes)); });
}

}  // namespace selvedge::fuzz

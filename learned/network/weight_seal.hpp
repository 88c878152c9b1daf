#pragma once

#include <filesystem>

namespace selvedge {

// Bytes before the HDF5 part of a weight file.
constexpr int seal_bytes = 512;

// Writes the line `selvedge weights 1 CHECKSUM LENGTH` into the first `seal_bytes` of the file, which must be free.
// Checksum (FNV-1a, 64 bits, which detects each single changed byte) and length are of the bytes after it.
void write_seal(const std::filesystem::path&);

// Returns the length after the seal. Throws Error for a file without a seal, and where it does not fit.
long long check_seal(const std::filesystem::path&);

}  // namespace selvedge

#pragma once

#include <filesystem>

namespace selvedge {

// Bytes before the HDF5 part of a weight file.
constexpr int seal_bytes = 512;

// Writes the line `selvedge weights 1 CHECKSUM LENGTH` to the start of the file, where `seal_bytes` are left free for
// it. The checksum (FNV-1a, 64 bits, which no single changed byte leaves as it was) and the length are of what comes
// behind.
void write_seal(const std::filesystem::path&);

// Returns the length of what comes behind the seal. Throws Error for a file without one, and where it does not fit.
long long check_seal(const std::filesystem::path&);

}  // namespace selvedge

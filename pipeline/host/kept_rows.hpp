#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace selvedge {

// Long suites keep each finished row in a file, with a key of the program and of everything that the row depends on.
// The same command then goes on where it was stopped, and another program or setting runs anew.

std::string whole_file(const std::filesystem::path&);  // empty where there is none
std::uint64_t hash_of(const std::string&);             // Fowler, Noll and Vo's 64-bit hash, variant 1a
std::string program_key();                             // of this program's own file

}  // namespace selvedge

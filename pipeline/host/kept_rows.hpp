#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace selvedge {

// Long suites keep each finished row in a file, with a key of the program and of everything that the row depends on.
// The same command then goes on where it was stopped, and another program or setting runs anew.

std::string whole_file(const std::filesystem::path&);  // empty where there is none
// Fowler, Noll and Vo's 64-bit hash, variant 1a; `before`: of what comes before the bytes.
std::uint64_t hash_of(std::string_view, std::uint64_t before = 0xcbf29ce484222325u);
std::uint64_t hash_of_file(const std::filesystem::path&);  // of its bytes; that of no bytes where there is none
// Of the file that holds this code: the program, or the extension that a program such as Python has loaded.
std::string program_key();

}  // namespace selvedge

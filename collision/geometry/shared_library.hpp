#pragma once

#include <filesystem>
#include <string>

namespace selvedge {

// The path of a shared library beside the running program: for parts that are built only on request, and opened only
// when they are used.
std::filesystem::path library_beside_program(const std::string& name);

// Opens a library, which is never closed, and returns its function `entry`; null if it has none. `noun`: what it
// brings. `global`: its symbols, and those of the libraries that it needs, serve libraries that are opened later.
// Throws Error with the cure where it cannot be opened.
void* entry_of_library(const std::filesystem::path&, const char* entry, const std::string& noun,
                       const std::string& cure, bool global = false);

}  // namespace selvedge

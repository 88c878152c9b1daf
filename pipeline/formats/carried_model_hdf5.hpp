#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "collision/geometry/surface.hpp"
#include "physics/steppers/carried_guess.hpp"

namespace selvedge {

// Coefficients of the carried guess, as `selvedge teach` leaves them.
struct TaughtCarried {
  CarriedModel model;
  std::vector<std::string> clips;  // that they were fitted on
  std::uint64_t mesh = 0;          // mesh_hash of the cloth that they were fitted on
  int vertices = 0;                // of that cloth
};

std::uint64_t mesh_hash(const Surface&);  // of the number of vertices and of the triangles

// A small file: 4 bytes a coefficient of a vertex's own set, which are rounded to float. Reading checks it; both
// functions throw Error.
void write_taught_carried(const std::filesystem::path&, const TaughtCarried&);
TaughtCarried read_taught_carried(const std::filesystem::path&);

// Throws Error, which names the file, where sets of vertices are of another cloth. Without such sets the coefficients
// fit every scene.
void check_fits(const TaughtCarried&, const Surface&, const std::filesystem::path&);

}  // namespace selvedge

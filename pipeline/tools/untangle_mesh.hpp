#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "collision/untangle/untangle.hpp"

namespace selvedge {

struct UntangleRequest {
  std::filesystem::path file, out;            // meshes (OBJ, PLY)
  std::vector<std::filesystem::path> bodies;  // at rest, in the same unit
  std::string unit = "m";                     // unit of the coordinates, for the lengths in the report
  std::vector<int> layers;                    // as in UntangleOptions
  int iterations = 300;
  std::function<void(const UntangleProgress&)> progress;  // lengths in the file's unit
};

struct UntangleReport {
  UntangleResult result;  // lengths in metres; positions in the file's unit
  int vertices = 0, triangles = 0, bodies = 0;
  int inside_before = 0, inside_after = 0;  // cloth vertices inside a closed body, as the audit counts them
  int audited_pairs = 0;                    // pairs that the independent audit finds in the result
  int degenerate_before = 0, degenerate_after = 0;
  double mean_edge = 0;  // [m]
  double seconds = 0;
  std::vector<std::string> warnings;
};

// Reads, untangles, audits and writes. Faces keep the order of the file. OBJ to OBJ changes the positions only.
// Otherwise positions and triangles are written, and a warning names the lost parts.
UntangleReport untangle_mesh(const UntangleRequest&);

// Whether there are no intersecting pairs, no pairs that cross at a shared vertex, and nothing inside a body.
bool is_clean(const UntangleReport&);

std::string untangle_json(const UntangleReport&);
std::string untangle_text(const UntangleReport&);

}  // namespace selvedge

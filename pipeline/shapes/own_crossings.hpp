#pragma once

#include <string>
#include <vector>

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// Where a surface crosses itself.
struct OwnCrossings {
  struct Between {
    std::string a, b;  // names of meshes, equal for one that crosses itself; empty: the file has no names
    int pairs = 0;     // of triangles
  };
  std::vector<Between> between;
  bool too_many = false;  // more pairs than the budget (pair_budget.hpp): the list is not complete
  int pairs() const;
};

// Crossings at x [m] of the surface joined at its seams. `places`: of each vertex the lowest one at its place
// (same_places.hpp). A pair of triangles from two meshes counts as between these.
OwnCrossings own_crossings(const NamedVertices& meshes, const Points& x, const Triangles&,
                           const std::vector<int>& places);

// For example "12 pairs of triangles (`arm` with `chest` 10, `arm` 2)"; empty if there are none.
std::string crossings_text(const OwnCrossings&);

// Adds a warning if the surface of `name`, an obstacle or a body, crosses itself.
void warn_of_crossings(const std::string& name, const OwnCrossings&, std::vector<std::string>& warnings);
void warn_of_crossings(const std::string& name, const Mesh&, std::vector<std::string>& warnings);

}  // namespace selvedge

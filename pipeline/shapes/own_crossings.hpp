#pragma once

#include <string>
#include <vector>

#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// Where a surface crosses itself.
struct OwnCrossings {
  struct Between {
    std::string a, b;  // meshes, the same for one that crosses itself; empty: the file names none
    int pairs = 0;     // of triangles
  };
  std::vector<Between> between;
  bool too_many = false;  // more than are looked at (pair_budget.hpp): what is given is not all
  int pairs() const;
};

// At x [m], of the surface that is joined at its seams. `places`: of each vertex the lowest one at its place
// (same_places.hpp). A pair that meshes share counts as between two.
OwnCrossings own_crossings(const NamedVertices& meshes, const Points& x, const Triangles&,
                           const std::vector<int>& places);

// "12 pairs of triangles (`arm` with `chest` 10, `arm` 2)"; empty where there are none.
std::string crossings_text(const OwnCrossings&);

// Adds the warning that `name`'s surface crosses itself, if it does: for what becomes an obstacle or a body of a run.
void warn_of_crossings(const std::string& name, const OwnCrossings&, std::vector<std::string>& warnings);
void warn_of_crossings(const std::string& name, const Mesh&, std::vector<std::string>& warnings);

}  // namespace selvedge

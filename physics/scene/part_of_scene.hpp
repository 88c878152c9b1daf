#pragma once

#include <span>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// Some of a scene's triangles with all of its obstacles, as a scene of their own, and the way between the two
// numberings.
struct PartOfScene {
  Scene scene;
  std::vector<int> vertices, triangles, cloths,
      pins;  // of the part: their numbers in the whole; pins: positions in Scene::pins
  int whole_triangles = 0, whole_cloths = 0;
};
// The chosen ones, one a cloth. Cloths that springs join must be chosen together (assert).
PartOfScene part_of(const Scene&, std::span<const char> cloths);
// The chosen ones, one a triangle, with their vertices and with vertices that have no triangle in the whole. A spring
// that loses an end is left out; so is a cloth that loses all vertices.
PartOfScene part_of_triangles(const Scene&, std::span<const char> triangles);

// With the rows of memory that belong to the part.
State state_of(const PartOfScene&, const State& whole);
Drive drive_of(const PartOfScene&, const Drive& whole);

// Puts what a step has made of the part into a state of the whole, all but what only the whole has. Its memory is the
// part's then; in it, places that the part lacks are where the whole has them, and other rows are 0.
void put(const PartOfScene&, const State& part, State& whole);
// The same of an audit, where the rest of the whole is clean.
Audit whole_audit(const PartOfScene&, Audit part);

}  // namespace selvedge

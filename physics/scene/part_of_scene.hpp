#pragma once

#include <span>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// Some of a scene's triangles and all of its obstacles, as a scene of their own, with the map between both numberings.
struct PartOfScene {
  Scene scene;
  std::vector<int> vertices, triangles, cloths,
      pins;  // of the part: their numbers in the whole; pins: positions in Scene::pins
  int whole_triangles = 0, whole_cloths = 0;
};
// cloths: 1 for each chosen cloth. Cloths that springs join must be chosen together (assert).
PartOfScene part_of(const Scene&, std::span<const char> cloths);
// triangles: 1 for each chosen triangle. The part has their vertices, and the vertices that have no triangle in the
// whole. A spring that loses an end is left out; so is a cloth that loses all vertices.
PartOfScene part_of_triangles(const Scene&, std::span<const char> triangles);

// The state of the part, with the rows of memory that belong to it.
State state_of(const PartOfScene&, const State& whole);
Drive drive_of(const PartOfScene&, const Drive& whole);

// Writes the part's state after a step into a state of the whole; cloth that is not in the part stays as it is. The
// whole's memory becomes the part's. Rows that the part lacks are the whole's positions in blocks of positions, else 0.
void put(const PartOfScene&, const State& part, State& whole);
// Writes the contact forces on the part's cloth into those of the whole.
void put(const PartOfScene&, const ContactForces& part, ContactForces& whole);
// An audit of the part as one of the whole, if the rest of the whole is clean.
Audit whole_audit(const PartOfScene&, Audit part);

}  // namespace selvedge

#pragma once

#include <string>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// Scenes from arrays. All throw Error for arrays that do not fit together.

// Rest shapes of triangles in space, each flattened into its own plane.
std::vector<RestTriangle> flattened(const Points& rest, const Triangles&);

// A cloth that add_cloths appends; `metric` may be empty.
struct NewCloth {
  const Points& rest;
  const Triangles& triangles;
  const Material& material;
  const std::string& name;
  const std::vector<RestTriangle>& metric;
};

// Appends cloths, as add_cloth does one after the other.
void add_cloths(Scene&, const std::vector<NewCloth>&);

// Appends a cloth of n x 3 rest positions [m] and triangles of its own vertices; returns its number. `metric` are the
// rest shapes of its triangles, in place of the flattened ones. Without a name it is called cloth0, cloth1, ... Curved
// rest shapes bend back to themselves only where Scene::rest_is_flat is unset.
int add_cloth(Scene&, const Points& rest, const Triangles&, const Material& = {}, const std::string& name = {},
              const std::vector<RestTriangle>& metric = {});

// Appends an obstacle; returns its number. Its positions are in State::obstacles and Drive::obstacles.
int add_obstacle(Scene&, int vertex_count, const Triangles&, bool moving = false, const std::string& name = {});

// Time 0, at rest, with the cloths' positions on end and those of every obstacle [m].
State first_state(const Scene&, const Points& x, const std::vector<Points>& obstacles = {});

// A world that holds pins and obstacles where the state has them, under gravity.
Drive at_rest(const Scene&, const State&);

}  // namespace selvedge

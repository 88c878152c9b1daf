#pragma once

#include <string>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// Scenes from arrays. All throw Error for arrays whose sizes or indices do not match.

// Rest shapes of triangles in space, each flattened into its own plane.
std::vector<RestTriangle> flattened(const Points& rest, const Triangles&);

// Arguments of add_cloth for one of several cloths; `metric` may be empty.
struct NewCloth {
  const Points& rest;
  const Triangles& triangles;
  const Material& material;
  const std::string& name;
  const std::vector<RestTriangle>& metric;
};

// Appends several cloths, as calls of add_cloth would.
void add_cloths(Scene&, const std::vector<NewCloth>&);

// Appends a cloth of n x 3 rest positions [m] and triangles of its own vertices; returns its number. `metric` are the
// rest shapes of its triangles, in place of the flattened ones. Without a name it is called cloth0, cloth1, ... Bending
// forces toward a curved rest shape need Scene::rest_is_flat = false.
int add_cloth(Scene&, const Points& rest, const Triangles&, const Material& = {}, const std::string& name = {},
              const std::vector<RestTriangle>& metric = {});

// Appends an obstacle; returns its number. Its positions are in State::obstacles and Drive::obstacles.
int add_obstacle(Scene&, int vertex_count, const Triangles&, bool moving = false, const std::string& name = {});

// The state at time 0, at rest. x: positions of all cloths, one after the other [m]; then those of every obstacle [m].
// Throws Error for other numbers of them, and for a vertex without mass in a triangle that is no pin: it would hold the
// cloth.
State first_state(const Scene&, const Points& x, const std::vector<Points>& obstacles = {});

// A drive that keeps pins and obstacles where they are in the state, under gravity.
Drive at_rest(const Scene&, const State&);

}  // namespace selvedge

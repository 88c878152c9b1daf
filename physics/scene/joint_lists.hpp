#pragma once

#include <array>
#include <string>
#include <vector>

#include "physics/scene/scene.hpp"

namespace selvedge {

// A kind of joint: elements with an energy of their own, each of a few vertices.
struct JointKind {
  const char* name;        // in a plan, and in StepperTraits::ignores
  const char* joint;       // one of them, in errors
  const char *one, *many;  // what they are, in a plan
};

// Calls `visit` with each list of joints that a scene has. Checks, plans, parts of a scene, assembly and measures go
// through it. A kind has nodes_of and renumber here, number_fields (scene_numbers.hpp), and joint_energy and
// joint_derivatives (physics/energies/joints.hpp). How to add one: docs/extending.md.
template <class Visit>
void for_each_joint_list(const Visit& visit) {
  visit(&Scene::springs, JointKind{"springs", "spring", "pair of vertices joined", "pairs of vertices joined"});
}

// The names of all kinds, for traits of a stepper that models no joints.
inline std::vector<std::string> joint_names() {
  std::vector<std::string> names;
  for_each_joint_list([&](auto, const JointKind& kind) { names.push_back(kind.name); });
  return names;
}

inline std::array<int, 2> nodes_of(const Spring& spring) { return {spring.a, spring.b}; }
inline void renumber(const std::array<int, 2>& nodes, Spring& spring) { spring.a = nodes[0], spring.b = nodes[1]; }

}  // namespace selvedge

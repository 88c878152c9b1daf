#pragma once

#include <array>
#include <memory>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// A vertex without mass, which goes with three others: sum weights_i x_i.
struct Follower {
  int vertex = 0;
  std::array<int, 3> of{};
  Vec3 weights = Vec3::Zero();
};

// Does what the stepper does and then puts the followers, numbered as the scene's vertices, where those that they
// follow have come to, with their velocity. All of them are pins of the scene; their rows of the drive count for
// nothing. It stands round all other steppers: what they remember of a follower's place becomes where it is, so that
// none of them sees a pin that moves. Without followers it is the stepper itself. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_following_stepper(const Scene&, std::vector<Follower>, std::unique_ptr<Stepper>);

}  // namespace selvedge

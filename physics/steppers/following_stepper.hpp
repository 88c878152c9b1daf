#pragma once

#include <array>
#include <memory>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// A vertex without mass that follows three others: its position is sum weights_i x_i.
struct Follower {
  int vertex = 0;
  std::array<int, 3> of{};
  Vec3 weights = Vec3::Zero();
};

// Makes the step of the inner stepper, then sets position and velocity of the followers (vertices of the scene) from
// those of the vertices that they follow. Followers must be pins of the scene; their rows of the drive are ignored.
// This stepper stands round all others: it sets the followers' places in their memory too, so that none of them sees a
// pin that moves. Without followers it returns the inner stepper. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_following_stepper(const Scene&, std::vector<Follower>, std::unique_ptr<Stepper>);

}  // namespace selvedge

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/motions/clip_procedural_track.hpp"

// The movements that procedural clips are made of.
namespace selvedge {

struct NamedMovement {
  std::string name;
  std::function<Movement(const Skeleton&)> make;
};

std::vector<NamedMovement> gait_movements();      // walking, running
std::vector<NamedMovement> exercise_movements();  // on the spot
std::vector<NamedMovement> everyday_movements();  // sitting, reaching, bowing
std::vector<NamedMovement> dance_movements();
std::vector<NamedMovement> penetrating_movements();  // the body passes through itself

// A movement that starts with the feet side by side at the origin.
Movement movement(const Skeleton&, double seconds);

// Keeps a figure from one time to another.
void hold(Movement&, double from, double to, const Figure&);

// A movement that starts so and stands until `rest` [s].
Movement from_rest(const Skeleton&, double seconds, double smoothing, double rest);

// The movement, with that figure from `rest` [s] on to its end.
Movement to_rest(Movement, double rest, const Figure& = standing());

// A place on the ground turned to the left about the origin.
Vec3 turned_left(const Vec3& place, double yaw);

}  // namespace selvedge

#pragma once

#include <string>
#include <vector>

#include "pipeline/motions/clip_procedural_track.hpp"

// The movements that procedural clips are made of.
namespace selvedge {

struct NamedMovement {
  std::string name;
  Movement (*make)(const Skeleton&);
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

}  // namespace selvedge

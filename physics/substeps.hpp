#pragma once

#include <span>

#include "collision/contact_pairs.hpp"
#include "physics/scene.hpp"
#include "physics/stepper.hpp"

namespace selvedge {

// Where a step has come to: all nodes, and the cloth's velocity.
struct Leg {
  Points nodes, v;
};

// How many parts a step of dt [s] is cut into: as many as keep every vertex's motion in a substep within a few mesh
// edges (edge_length: the mean one [m]) and that of touching pairs past each other within one, and at least two:
// implicit Euler at 1/30 s damps visibly. contact_speed [m/s]: of the pairs that touch.
int substeps_for(const State& from, const Drive&, double dt, double edge_length, int max_substeps,
                 double contact_speed = 0);

// The largest speed of a pair's one primitive past the other, of one vertex each [m/s].
double fastest_past(std::span<const NodePair>, const State& from, const Drive&, double dt);

// Writes where and when a step of dt [s] from `from` has come to, all but the obstacles.
void arrive(const State& from, const Leg&, double dt, State& to);

Points pinned_rows(const Scene&, const Points& nodes);  // one row a Scene::pins entry

}  // namespace selvedge

#pragma once

#include <optional>
#include <span>

#include "collision/contact/contact_pairs.hpp"
#include "collision/contact/response.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"
#include "physics/solve/bdf2.hpp"
#include "physics/steppers/substep_options.hpp"

namespace selvedge {

// Where a step has come to: all nodes, the cloth's velocity, and what an integrator of two steps goes on from.
struct SubstepState {
  Points nodes, v;
  StepHistory history = {};
};

// How many parts a step of dt [s] is cut into. edge_length: the mean one [m]; speeds in m/s.
// Two at least of a step that is longer than the longest substep.
int least_substeps(double dt, const SubstepOptions&);
// As many as keep every vertex's motion in a substep within a few mesh edges, and least_substeps.
int substeps_for_speed(const State& from, const Drive&, double dt, double edge_length, int max_substeps,
                       const SubstepOptions&);
// As many as keep the motion of touching pairs past each other within `max_slide`.
int substeps_for_contact(double contact_speed, double dt, double edge_length, int least, int most,
                         const SubstepOptions&);
// As many as keep each part of a motion of `distance` [m] past each other within a few edges: contact cannot be
// linearised over more.
int parts_for_distance(double distance, double edge_length, int most, const SubstepOptions&);

// The largest speed of a pair's one primitive past the other, of one vertex each [m/s].
double fastest_past(std::span<const NodePair>, const State& from, const Drive&, double dt);

// The farthest that nodes of one primitive of an impact move past those of the other, of all [m].
double farthest_past(std::span<const Impact>, const Points& nodes0, const Points& nodes1);

// How far impacts are from their targets at the end, at most [m].
double deepest(std::span<const Impact>, const Points& nodes1);
// How deep an impact may be for impulses alone to meet it: part of an edge, and where triangles are narrower than
// contact is thick, no more than that [m].
double deep_impact(const Scene&, const SubstepOptions&);

// A start with every obstacle where it is wanted that would have to move farther than its own size (the diagonal of its
// box) in a substep: that is no motion to sweep along but a new start, and a tangled one it may be.
struct Restart {
  State state;
  int jumped = 0;  // obstacles
};
// Absent where no obstacle jumps, and where the state's obstacles lag: those are on their way.
std::optional<Restart> restart_of(const State& from, const Drive&, int max_substeps);

Points pinned_rows(const Scene&, const Points& nodes);  // one row a Scene::pins entry

}  // namespace selvedge

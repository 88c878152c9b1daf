#pragma once

#include <span>

#include "learned/graph/graph_state.hpp"
#include "learned/graph/integration.hpp"
#include "physics/scene/scene.hpp"
#include "physics/steppers/finish_step.hpp"

namespace selvedge {

constexpr double learned_dt = 1.0 / 30;    // of a frame [s]; networks are trained with it
constexpr double settling_time = 1.0 / 3;  // that the pass counts in which cloth falls to rest [s]

// By the drive's acceleration and, where the scene has wind, by the wind on each triangle, V x 3 [m/s2]; v in m/s.
Points free_acceleration(const Scene&, const Points& x, const Points& v, const Drive&);

// Whether cloth is to see cloth: there are several, or contact of a cloth with itself is asked for.
bool sees_cloth_edges(const Scene&);

// Whether a network has not made the state, so that its roll-out begins here: the state's memory is not a learned
// stepper's, or of another scene.
bool begins_rollout(const State&);

// What a network starts a frame from. This is the only place where velocities in m/s become displacements per frame:
// a state that a network made keeps its own in State::memory, with where cloth and body were before; another state's
// are v dt, and its cloth comes from x - v dt. The body goes from the state's obstacles to the drive's. Pinned vertices
// have their target at the drive's pins, others where they are. The acceleration is that of gravity and of the wind on
// each triangle.
GraphState graph_state(const Scene&, const State& from, const Drive&);

// The frame that a network made of `state`; `seen` is where the network saw the cloth (seen_positions.hpp). Velocities
// in m/s are what the network carries, and those of pinned vertices what they did.
StepEnd learned_end(const Scene&, const State& from, const Drive&, const GraphState&, const Points& seen,
                    const NextCloth&);

// For a step that another stepper made: writes into `to` the memory that a network's step would have left, so that no
// roll-out begins there. The velocity is the cloth's motion in the frame.
void carry_frame(const State& from, State& to);

// For cloth that another stepper has moved after a network's step: the positions in the memory move along [m]. Nothing
// happens where the state carries nothing.
void change_carried_velocity(const Points& change, State&);

// What a network carries of these vertices' velocities becomes what State::v has of them. Nothing happens to a state
// that no network made.
void carry_velocities(std::span<const int> vertices, State&);

}  // namespace selvedge

#pragma once

#include <span>

#include "learned/graph/graph_state.hpp"
#include "learned/graph/integration.hpp"
#include "physics/scene/scene.hpp"
#include "physics/steppers/finish_step.hpp"

namespace selvedge {

constexpr double learned_dt = 1.0 / 30;    // of a frame [s], as in the training of all networks
constexpr double settling_time = 1.0 / 3;  // time step of the pass in which cloth falls to rest [s]

// Acceleration by the drive and, in a scene with wind, by the wind on each triangle, V x 3 [m/s2]; v in m/s.
Points free_acceleration(const Scene&, const Points& x, const Points& v, const Drive&);

// Whether the graph has edges between cloths: if there are several cloths, or contact of a cloth with itself is on.
bool sees_cloth_edges(const Scene&);

// Whether a roll-out begins at this state, because no network made it: its memory is not a learned stepper's, or is of
// another scene.
bool begins_rollout(const State&);

// The graph state from which a network starts a frame. This is the only place where velocities in m/s become
// displacements per frame. A state that a network made keeps its displacements in State::memory, with the previous
// positions of cloth and body. For another state they are v dt, and its previous positions are x - v dt. The body moves
// from the state's obstacles to those of the drive. The target of pinned vertices is the drive's pins, that of other
// vertices their position. The acceleration is that of gravity and of the wind on each triangle.
GraphState graph_state(const Scene&, const State& from, const Drive&);

// The end of a network's frame. `seen` has the positions that the network read (seen_positions.hpp). Velocities in m/s
// are those that the network carries; velocities of pinned vertices are their motion.
StepEnd learned_end(const Scene&, const FeatureOptions&, const State& from, const Drive&, const GraphState&,
                    const Points& seen, const NextCloth&);

// For a network whose output is added to the carried guess (OutputBase::carried): sets the state's guess to that, its
// heading to the turn about the vertical that brings the rest shape nearest to the skinned targets, its frames to how
// these turned since the last frame, from that heading, and what is seen of the targets. Reads what carried_memory left
// in `from`. Cloth that nothing wears, and a state without that memory, have neither heading, frames nor targets.
void set_carried_base(const Scene&, const State& from, const Drive&, double dt, GraphState&);

// For a step that another stepper made: writes into `to` the memory that a network's step would have left, so that no
// roll-out begins there. The velocity is the cloth's motion in the frame.
void carry_frame(const State& from, State& to);
// The same for a network with these features, of which some remember the carried guess too.
void carry_frame(const FeatureOptions&, const State& from, const Drive&, State& to);

// Sets the velocities that a network carries for these vertices to those of State::v. Does nothing to a state that no
// network made.
void carry_velocities(std::span<const int> vertices, State&);

}  // namespace selvedge

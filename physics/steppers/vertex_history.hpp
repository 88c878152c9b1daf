#pragma once

#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/solve/bdf2.hpp"
#include "physics/solve/contact_terms.hpp"

namespace selvedge {

// What `solver.integrator: bdf2` needs of a scene: its connected parts, and which of them are pinned.
struct PinnedParts {
  explicit PinnedParts(const Scene&);
  std::vector<int> part;     // of each vertex
  std::vector<char> pinned;  // of each part
};

// Contact in a substep, of each vertex: where a term is, it is `near` if something was near before, and else `begun`.
// What was marked in an earlier solve of the substep stays.
void mark_near(const StepHistory&, const Contacts&, std::vector<VertexContact>&);
// Marks the vertices that the response has moved from `wanted` to `nodes`.
void mark_moved(const Points& wanted, const Points& nodes, std::vector<VertexContact>&);

// Whether a pin changes its motion in a substep by more than `most` [m] from the last substep to the one from `nodes0`
// to `pins`, one row a Scene::pins entry. Without a history none does.
bool pins_jump(const Scene&, const StepHistory&, const Points& nodes0, const Points& pins, double most);

// The rule of each vertex in a substep of h [s]. A vertex goes on with BDF2 unless its velocity may have jumped:
// something comes near it, or contact began in the last substep. It is then implicit Euler's, or, where nothing is
// near, begins anew; so it does where the history is of another length. A part that neither pins nor obstacles can hold
// has one rule for all, so that its momentum is kept: implicit Euler's if it is near other cloth, and else BDF2 only if
// nothing was near it.
std::vector<VertexRule> vertex_rules(const PinnedParts&, const StepHistory&, double h, const Contacts&,
                                     const std::vector<VertexContact>&);

// Velocities at the substep's end x1, where the solve has found `solved`, and friction and impulses have moved that to
// x1 in h [s].
Points end_velocities(const VertexStarts&, const Points& solved, const Points& x1, double h);

}  // namespace selvedge

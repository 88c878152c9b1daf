#pragma once

#include <memory>
#include <optional>
#include <span>

#include "collision/contact/response.hpp"
#include "physics/energies/contact_energy.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"
#include "physics/solve/bdf2.hpp"
#include "physics/steppers/substep_options.hpp"

namespace selvedge {

// The present state of a step: all nodes, the cloth's velocity, the history for a two-step integrator, and what contact
// exerts on the cloth, if that is measured.
struct SubstepState {
  Points nodes, v;
  StepHistory history = {};
  std::shared_ptr<const ContactForces> forces = {};
};

// Numbers of substeps for a step of dt [s]. edge_length: the mean one [m]; speeds in m/s.
// Enough that none is longer than SubstepOptions::longest, by more than a twentieth of it.
int least_substeps(double dt, const SubstepOptions&);
// Enough to keep every vertex's motion in a substep within a few mesh edges, and at least least_substeps.
int substeps_for_speed(const State& from, const Drive&, double dt, double edge_length, int max_substeps,
                       const SubstepOptions&);
// Parts of a substep, since contact cannot be linearised over more. In each of them a contact slides by at most
// `max_slide` edges, and a pair moves on after its impact by at most `max_motion` edges.
int parts_for_slide(double slide, double edge_length, int most, const SubstepOptions&);
int parts_for_impact(double distance, double edge_length, int most, const SubstepOptions&);

// How far the contacts that press slide, at most, both at the speed at which the substep begins, which leads to
// `coasting`, and in its solve, which ends at x1 [m].
double farthest_slide(std::span<const ContactTerm>, const Points& x0, const Points& coasting, const Points& x1);
// How far the touching points of an impact move on past each other after it, at most [m].
double farthest_past(std::span<const Impact>, const Points& nodes0, const Points& nodes1);

// The largest distance of an impact from its target at the end [m].
double deepest(std::span<const Impact>, const Points& nodes1);
// The largest depth of an impact that impulses alone respond to: a part of an edge, but at most the thickness if some
// triangle is narrower than it [m].
double deep_impact(const Scene&, const SubstepOptions&);

// A start in which obstacles that would move farther than their own size (the diagonal of the box) in a substep are
// where they are wanted. Such a jump is not swept; the new start may be tangled.
struct Restart {
  State state;
  int jumped = 0;  // obstacles
};
// Absent if no obstacle jumps, or if the state's obstacles lag, since these are on their way.
std::optional<Restart> restart_of(const State& from, const Drive&, int max_substeps);

}  // namespace selvedge

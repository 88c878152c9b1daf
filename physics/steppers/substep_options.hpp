#pragma once

#include "physics/solve/contact_term_options.hpp"

namespace selvedge {

// How a step is cut into substeps, and how a substep alternates implicit solves with Bridson's response. Members are
// described where keys are bound to them: pipeline/scene/config_solver.cpp.
struct SubstepOptions {
  double longest = 1.0 / 48;
  double first_tolerance = 8, friction_tolerance = 0.2;
  int max_passes = 6;
  double normal_change = 0.05;
  ContactTermOptions contact;

  // A step is cut so that pairs that meet move on after their impact by at most this many mean edges in a substep
  // (with icm: all vertices), as far as max_substeps allows.
  static constexpr double max_motion = 2.5;
  // It is cut so that a contact that presses slides by at most this many mean edges. More locks cloth that is pulled
  // round a post.
  static constexpr double max_slide = 1;
  // An impact this many mean edges deep becomes a term of the next solve.
  static constexpr double deep_impact = 0.05;
  // A solve with contact may take this part of max_newton, since another one follows.
  static constexpr double contact_iterations = 0.5;
  // A first solve that another one follows takes at most this many iterations, or that part of max_newton if more.
  static constexpr int rough_iterations = 4;
  // A substep without room solves again at most this often, since no stiffness makes room.
  static constexpr int pinched_passes = 3;
  // A substep whose zones do not converge is halved this often before the last resort.
  static constexpr int max_halvings = 2;
  // Zones take this many rounds in a substep that may still be halved, and this many where there is no room.
  static constexpr int halving_zone_rounds = 12, pinched_zone_rounds = 4;
  // A response is refused if it raises the potential to this many times the energy before.
  static constexpr double max_energy_ratio = 10;
  // Where the last resort is refused, cloth and obstacles keep this part of their motion up to the first impact.
  static constexpr double part_to_impact = 0.5;
};

}  // namespace selvedge

#pragma once

namespace selvedge {

// How contact enters the incremental potential of a step (contact_terms.hpp).
struct ContactTermOptions {
  double stiffness = 200;  // A term begins this many times as stiff as its pair's mass over the time step squared.
  double overlap_removed = 0.1;    // A step lifts by this part of an overlap; a load sinks by this part of a gap.
  double onset = 0.02;             // The force sets in smoothly over this part of the thickness.
  double load_sink = 0.01;         // A load may press a term in by this part of the thickness.
  double impact_sink = 0.25;       // A stopped impact may sink by this part of the gap at which it is stopped.
  double max_stiffening = 100;     // Loads raise a stiffness at most this many times in a step.
  double same_side = 0.7;          // A term is linearised anew if the cosine of its old and its new normal is larger.
  int static_friction_sweeps = 4;  // Static friction takes this many Gauss-Seidel sweeps over the pairs.
};

}  // namespace selvedge

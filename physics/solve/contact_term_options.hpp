#pragma once

namespace selvedge {

// How contact enters the incremental potential of a step (contact_terms.hpp). Members are described where keys are
// bound to them: pipeline/scene/config_solver.cpp.
struct ContactTermOptions {
  double stiffness = 200;
  double overlap_removed = 0.1;

  // The force rises smoothly over this part of the thickness.
  static constexpr double onset = 0.02;
  // A shorter step [s] removes the smaller part of an overlap: a fixed part would throw cloth up the faster, the
  // shorter steps are.
  static constexpr double full_step = 1e-3;
  // A load may press a term in by this part of the thickness.
  static constexpr double load_sink = 0.01;
  // A stopped impact may sink by this part of the gap at which it is stopped.
  static constexpr double impact_sink = 0.25;
  // Loads raise a stiffness at most this many times in a step.
  static constexpr double max_stiffening = 1e4;
  // A term is linearised anew if the cosine of its old and its new normal is larger.
  static constexpr double same_side = 0.7;
  // Static friction takes this many Gauss-Seidel sweeps over the pairs.
  static constexpr int static_friction_sweeps = 4;
};

}  // namespace selvedge

#pragma once

namespace selvedge {

// How a step that starts tangled prepares the cloth (parting.hpp). Members are described where keys are bound to them:
// pipeline/scene/config_run.cpp.
struct RecoveryOptions {
  int untangling_passes = 400;
  double speed = 1;
  double farthest_place = 0.3;
  double push_softness = 0.1;

  // Untangling of cloth that crosses itself or lies in an obstacle.
  // Cloth with more crossing pairs per triangle is not untangled: its own stiffness opens it.
  static constexpr int max_pairs_per_triangle = 10;
  // Crossing pairs times passes stay below this in a step.
  static constexpr int max_pair_passes = 150'000;
  // Untangling stops at displacements longer than this many steps can make.
  static constexpr double useful_motions = 12;
  // Untangling may always take this many passes, however short the step.
  static constexpr int min_passes = 30;
  // If some cloth is trapped (recovery.hpp), untangling takes at most this many.
  static constexpr int trapped_passes = 40;
  // A motion after which more pairs cross is halved at most this often.
  static constexpr int max_halvings = 3;
  // A shorter displacement counts as none [mean edges].
  static constexpr double negligible_move = 1e-6;

  // Dressed cloth that a limb has gone through is put on again, or drawn to its skinned targets.
  // Untangling of cloth that is put on takes at most this many passes, and crossing pairs times passes stay below the
  // second number.
  static constexpr int placing_passes = 60, max_placing_pair_passes = 100'000;
  // A component is pierced if a limb goes through it, or if more than `pierced_part` of its vertices are tangled and
  // farther than `pierced_distance` mean edges from their targets.
  static constexpr double pierced_part = 0.03, pierced_distance = 0.5;
  // A component has sunken in if more than this part of its vertices is tangled.
  static constexpr double sunken_part = 0.01;
  // A part of a body is a limb if it reaches more than this many radii of a contour beyond it.
  static constexpr double long_limb = 2.5;
  // Cloth is drawn at most this fast [m/s].
  static constexpr double drawing_speed = 3;
  // Stiffness of drawing, over mass / h^2: 1000 where no part of a body is switched off, 1 where a part is. Trapped
  // cloth is drawn with 300.
  static constexpr double drawing_stiffness = 1000, trapped_stiffness = 300;
};

}  // namespace selvedge

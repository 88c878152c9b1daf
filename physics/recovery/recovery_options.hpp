#pragma once

namespace selvedge {

// How a step that starts tangled prepares the cloth (parting.hpp).
struct RecoveryOptions {
  int untangling_passes = 400;  // A step takes at most this many passes of untangling; the next one goes on.
  double speed = 1;             // A tangled vertex moves at most this fast [m/s].
  double farthest_place = 0.3;  // A vertex is put on at most this far from where it is [m].
  double push_softness = 0.1;   // The force that keeps parted cloth apart sets in over this part of the thickness.

  // Untangling of cloth that crosses itself or lies in an obstacle.
  // Cloth with more crossing pairs a triangle is left to its own stiffness.
  static constexpr int hopeless_pairs = 10;
  // Crossing pairs times passes stay below this in a step.
  static constexpr int max_pair_passes = 150'000;
  // No displacement longer than this many times a step's is looked for.
  static constexpr double useful_motions = 12;
  // Untangling may always take this many passes, however short the step.
  static constexpr int min_passes = 30;
  // Beside cloth that waits for a body to be free of itself it takes at most this many.
  static constexpr int waiting_passes = 40;
  // A motion after which more pairs cross is halved at most this often.
  static constexpr int max_halvings = 3;
  // A shorter displacement counts as none [mean edges].
  static constexpr double negligible_move = 1e-6;

  // Worn cloth that a limb has gone through is put on again, or drawn to its skinned targets.
  // Untangling gets this many passes where cloth is put on, and crossing pairs times passes stay below this.
  static constexpr int placing_passes = 60, max_placing_pair_passes = 100'000;
  // A component is pierced if a limb goes through it, or if more than this part of its vertices is tangled and so many
  // mean edges from its target.
  static constexpr double pierced_part = 0.03, astray = 0.5;
  // It has sunken in if more than this part of its vertices is tangled.
  static constexpr double sunken_part = 0.01;
  // A part of a body is a limb if it reaches more than this many radii of a contour beyond it.
  static constexpr double long_limb = 2.5;
  // Cloth is drawn at most this fast [m/s].
  static constexpr double carrying_speed = 3;
  // It is drawn 1000 times as stiffly as its inertia where nothing of a body is switched off, and as stiffly as that
  // where something is. Tangled cloth that waits is drawn 300 times as stiffly.
  static constexpr double carrying_stiffness = 1000, crossing_stiffness = 300;
};

}  // namespace selvedge

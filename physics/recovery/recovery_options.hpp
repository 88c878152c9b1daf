#pragma once

namespace selvedge {

// How a step that starts tangled prepares the cloth (parting.hpp).
struct RecoveryOptions {
  int untangling_passes = 400;  // A step takes at most this many passes of untangling; the next one goes on.
  double speed = 1;             // A tangled vertex moves at most this fast [m/s].

  // Untangling of cloth that crosses itself or lies in an obstacle.
  int hopeless_pairs = 10;        // Cloth with more crossing pairs than this a triangle is left to its own stiffness.
  int max_pair_passes = 150'000;  // Crossing pairs times passes stay below this in a step.
  double useful_motions = 12;     // No displacement longer than this many times a step's is looked for.
  int min_passes = 30;            // Untangling may always take this many passes, however short the step.
  int waiting_passes = 40;        // Beside cloth that waits for a body to be free of itself it takes at most this many.
  int max_halvings = 3;           // A motion after which more pairs cross is halved at most this often.
  double negligible_move = 1e-6;  // A shorter displacement counts as none [mean edges].

  // Worn cloth that a limb has gone through is put on again, or drawn to its skinned targets.
  double farthest_place = 0.3;            // A vertex is put on at most this far from where it is [m].
  int placing_passes = 60;                // Untangling gets this many passes where cloth is put on,
  int max_placing_pair_passes = 100'000;  // and crossing pairs times passes stay below this.
  double pierced_part = 0.03;             // A component is pierced if this part of its vertices is tangled and astray,
  double astray = 0.5;                    // which means this many mean edges from its target.
  double sunken_part = 0.01;              // It has sunken in if this part of its vertices is tangled.
  double long_limb = 2.5;                 // A limb reaches this many radii of the contour beyond it.
  double carrying_speed = 3;              // Cloth is drawn at most this fast [m/s],
  double carrying_stiffness = 1000;       // and this many times as stiffly as its inertia where the body is free of
                                          // itself,
  double crossing_stiffness = 300;        // or this many times where it is not: contact holds against it.
  double push_softness = 0.1;             // What keeps parted cloth parted sets in over this part of the thickness.
};

}  // namespace selvedge

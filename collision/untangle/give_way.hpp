#pragma once

#include <memory>

#include "collision/geometry/surface.hpp"

namespace selvedge {

struct GiveWayOptions {
  double room = 0.01;      // left between parts that come together, for cloth [m]; 0: they may just touch
  double most = 0.045;     // how far a vertex gives way [m]
  double rest_room = 0.3;  // Parts ask for at most this part of their distance at rest as room: a fold has a bottom.
  double through = 0.7;    // An offset leads through the body if its cosine with the normal is larger: skin curves.

  int press_sweeps = 12;    // Parts are pressed apart in this many sweeps,
  int press_rings = 6;      // and so many rings round them go along,
  double smoothing = 0.5;   // smoothed by this part in each sweep.
  int presses = 3;          // They are pressed for more room at most this often,
  double tight_part = 0.7;  // where less than this part of the room and of `most` is used,
  int press_halvings = 2;   // and each press is halved at most this often where it makes new crossings.

  int mend_rings = 1;        // What crosses is untangled together with so many rings round it,
  int mend_iterations = 40;  // in so many passes,
  double mend_gap = 0.1;     // to this gap [mean edges],
  double mend_far = 0.5;     // while other vertices move at most this far [mean edges],
  double overshoot = 1.5;    // and no vertex farther than this many times `most`.
  int mend_pressed = 60;     // A place is untangled as pressed if at most so many pairs cross there,
  int mend_skinned = 250;    // else as skinned if at most so many cross,
  int mend_spot = 10;        // and once pressed for more room only if so few do.

  double pinched_part = 0.4;  // Parts pinch cloth where less than this part of the room is left.
  int many_pinched = 20;      // They pass through each other where so many vertices pinch: cloth slips from fewer.
};

// A body's surface as it gives way, like soft tissue, where it would pass through itself: under the arms, between the
// thighs, in the bends of limbs. Skinning knows nothing of that, and cloth between faces that have passed each other
// has no place to be. Where more than `most` would be needed, a hand in the belly, the body still passes through
// itself: but for single spots it leaves room or crosses, and does not merely touch.
class GiveWay {
 public:
  // rest: the body where its parts are apart, as in the zero pose [m].
  GiveWay(Surface body, const Points& rest, const GiveWayOptions& = {});

  // The surface that is skinned to x, moved. Depends on x alone.
  Points operator()(const Points& x) const;

 private:
  std::shared_ptr<const struct SoftTissue> tissue_;
};

}  // namespace selvedge

#pragma once

#include <memory>

#include "collision/geometry/surface.hpp"

namespace selvedge {

struct GiveWayOptions {
  double room = 0.01;      // left for cloth between parts that come together [m]; 0: they may just touch
  double most = 0.045;     // how far a vertex may move [m]
  double rest_room = 0.3;  // At the bottom of a fold room is less: at most this part of the distance at rest.
  double through = 0.7;    // An offset leads through the body if its cosine with the normal is larger.

  int press_sweeps = 12;    // sweeps that press parts apart
  int press_rings = 6;      // rings of vertices round these parts that move along
  double smoothing = 0.5;   // of displacements, in each sweep
  int presses = 3;          // Parts are pressed for more room at most this often,
  double tight_part = 0.7;  // where less than this part of the room is there, and of `most` is used.
  int press_halvings = 2;   // Each press is halved at most this often where it makes new crossings.

  int mend_rings = 1;        // rings round crossing triangles that are untangled with them
  int mend_iterations = 40;  // most passes of untangling
  double mend_gap = 0.1;     // gap that untangling leaves [mean edges]
  double mend_far = 0.5;     // largest motion of other vertices [mean edges]
  double overshoot = 1.5;    // largest motion of any vertex, divided by `most`
  int mend_pressed = 60;     // A place is untangled from its pressed shape if at most so many pairs cross there,
  int mend_skinned = 250;    // else from its skinned shape if at most so many cross there;
  int mend_spot = 10;        // after a press for more room only if at most so many cross.

  double pinched_part = 0.4;  // Parts pinch cloth where less than this part of `room` is left.
  int many_pinched = 20;      // From so many pinching vertices on, parts are let through each other.
};

// Moves a skinned body's surface where it would pass through itself, as soft tissue does: under the arms, between the
// thighs, in the bends of limbs. Skinning does not prevent that, and cloth between faces that have passed each other
// has no room. Where more than `most` would be needed, as for a hand in the belly, the body still passes through
// itself. Except for single spots, parts then leave room or cross; they do not merely touch.
class GiveWay {
 public:
  static constexpr int recipe = 1;  // to be raised with every change of what it gives, for caches of results

  // rest: the body in a pose in which its parts are apart, such as the zero pose [m].
  GiveWay(Surface body, const Points& rest, const GiveWayOptions& = {});

  // The moved surface for skinned positions x, n x 3 [m]. Depends on x alone. `apart`, where given, becomes true if no
  // triangles of the moved surface intersect; false says nothing.
  Points operator()(const Points& x, bool* apart = nullptr) const;

 private:
  class Rest;
  std::shared_ptr<Rest> rest_;
};

}  // namespace selvedge

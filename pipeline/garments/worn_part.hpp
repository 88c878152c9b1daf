#pragma once

#include <string>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// The part of a body on which a garment is worn: the body's vertices nearest to garment vertices that are on the body.
// These are vertex numbers, so that the part moves with the body.
struct WornPart {
  struct Place {
    int foot = 0;      // of the body's vertices
    double reach = 0;  // the garment has left it if all garment vertices are farther than this [m]
    int vertex = 0;    // of the garment, above it
  };
  std::vector<Place> places;  // a sample, the highest feet first; empty: the garment is not on the body
};

// The part on which a garment x is worn. A vertex is on the body within `near`, a share of the garment's extent. If
// fewer than one vertex in twenty are, the garment is not on the body.
WornPart worn_part(const Points& x, const Points& body, double near = 0.1);

// The share of the part on which the garment still is, 0 to 1, and the same of the part's highest quarter.
struct ShareWorn {
  double all = 1, highest = 1;
};
ShareWorn share_worn(const WornPart&, const Points& x, const Points& body);

// Defines when a garment has left its body: less than half of the part on which it was worn has the garment near it,
// and less than a third of the highest quarter of that part, from which it hung. Cloth that slides along its part,
// rides up, swings or turns has not left; a skirt round the ankles has, and so has a hat on the shoulders. False for a
// part without places.
bool has_left(const WornPart&, const Points& x, const Points& body);

// A garment that is watched over frames.
struct WornWatch {
  std::string garment, body;  // names
  WornPart part;
  int left_in = -1;  // the frame since which it has left, as of the last frame seen; -1: it has not

  void see(int frame, const Points& x, const Points& body_now);
};

// For people: "garment `skirt` has slid off its body `person`, in frame 12".
std::string slid_off_text(const WornWatch&);

}  // namespace selvedge

#pragma once

#include <string>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// The part of a body that a garment is worn on: the vertices of the body that are nearest to those of the garment that
// lie on it, by numbers of the body, so that it moves with the body.
struct WornPart {
  struct Place {
    int foot = 0;      // of the body's vertices
    double reach = 0;  // farther than this from every vertex of the garment, the garment has left it [m]
    int vertex = 0;    // of the garment, above it
  };
  std::vector<Place> places;  // a sample, the highest feet first; empty: the garment is not on the body
};

// The part that a garment x is worn on. A vertex lies on the body within `near`, a share of the garment's extent; a
// garment of which fewer than one vertex in twenty do is not on it.
WornPart worn_part(const Points& x, const Points& body, double near = 0.1);

// The share of the part that the garment is still on, 0 to 1, and that of the part's highest quarter.
struct ShareWorn {
  double all = 1, highest = 1;
};
ShareWorn share_worn(const WornPart&, const Points& x, const Points& body);

// The one definition of a garment that has left its body: less than half of the part that it was worn on has any of the
// garment near it, and less than a third of the highest quarter of that part, which it hung from. Cloth that slides
// along its part, rides up, swings or turns has not; a skirt round the ankles has, and so has a hat on the shoulders.
// False for a part without places.
bool has_left(const WornPart&, const Points& x, const Points& body);

// A garment that is watched over frames.
struct WornWatch {
  std::string garment, body;  // names
  WornPart part;
  int left_in = -1;  // the frame since which it has left, up to the last one seen; -1: it has not

  void see(int frame, const Points& x, const Points& body_now);
};

// For people: "garment `skirt` has slid off its body `person`, in frame 12".
std::string slid_off_text(const WornWatch&);

}  // namespace selvedge

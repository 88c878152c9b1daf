#pragma once

#include <vector>

#include "collision/contact/contact_pairs.hpp"
#include "collision/contour/segments.hpp"

namespace selvedge {

// A contact world as input to searches for intersections: the cloth is sheet 0, obstacle k is sheet k + 1. `views`
// point into `positions`, so that the struct may be moved but not copied.
struct WorldSheets {
  std::vector<Points> positions;
  std::vector<SheetView> views;

  WorldSheets(const ContactWorld&, const Points& nodes);
  WorldSheets(WorldSheets&&) = default;
};

// Calls visit(triangle, sheet of the other triangle) for each triangle of the cloth in a crossing or touching pair,
// once per pair. Pairs of the cloth with itself count only if world.self.
template <class Visit>
void for_each_meeting(const ContactWorld& world, const Segments& found, Visit visit) {
  for (const Segment& segment : found.segments)
    if (segment.sheet[1] != 0 || world.self)
      for (int side = 0; side < 2; ++side)
        if (segment.sheet[side] == 0) visit(segment.triangle[side], segment.sheet[1]);
  for (const auto& [triangle, sheet, other] : found.touching) {
    if (sheet == 0 && !world.self) continue;
    visit(triangle, sheet);
    if (sheet == 0) visit(other, sheet);
  }
}

}  // namespace selvedge

#pragma once

#include <vector>

#include "collision/contact_pairs.hpp"
#include "collision/segments.hpp"

namespace selvedge {

// A contact world as searches for intersections see it: the cloth is sheet 0, obstacle k is sheet k + 1. The views look
// at the positions beside them: it may be moved but not copied.
struct WorldSheets {
  std::vector<Points> positions;
  std::vector<SheetView> views;

  WorldSheets(const ContactWorld&, const Points& nodes);
  WorldSheets(WorldSheets&&) = default;
};

}  // namespace selvedge

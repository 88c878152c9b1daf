#pragma once

#include <span>
#include <vector>

#include "collision/contour/contour.hpp"
#include "collision/contour/segments.hpp"

namespace selvedge {

// True if the curve on this side ends nowhere inside its sheet. At a loop vertex it continues as the curve of the other
// side.
bool ends_outside(const Contour&, int side);

// Vertices of a component that lie on the wrong side of a partner component (which may be the same).
struct Region {
  int sheet = 0, component = 0, partner_sheet = 0, partner_component = 0;
  std::vector<int> contours;  // between the two components
  std::vector<int> vertices;  // sorted
  bool cut = true;            // false: some of the contours do not cut the component, even together
};

// The regions of each component with each partner, from all contours between the two together: crossing a contour
// changes the side, and the smaller part is inside. Contours that allow no such colouring are left out, and `cut` says
// so. Against a closed obstacle the vertices of sheets[0] are those inside it, whatever the contours. Regions without
// vertices are listed too.
std::vector<Region> enclosed_regions(std::span<const SheetView> sheets, const Segments&, std::span<const Contour>);

}  // namespace selvedge

#pragma once

#include <span>
#include <vector>

#include "collision/contour/contour.hpp"
#include "collision/contour/segments.hpp"

namespace selvedge {

// Does the curve end nowhere inside its sheet? A side that ends at loop vertices does so together with the other side.
bool ends_outside(const Contour&, int side);

// Vertices of a component that lie on the wrong side of a partner component (which may be the same).
struct Region {
  int sheet = 0, component = 0, partner_sheet = 0, partner_component = 0;
  std::vector<int> contours;  // between the two
  std::vector<int> vertices;  // sorted
  bool cut = true;            // false: some of the contours do not part the component, even together
};

// Regions from all contours of a sheet with a partner together: their parity, the smaller part being inside. Contours
// that spoil the colouring are left out of it, and `cut` says so. Against a closed obstacle the vertices of sheets[0]
// are those inside it, whatever the contours. Regions without vertices are listed too.
std::vector<Region> enclosed_regions(std::span<const SheetView> sheets, const Segments&, std::span<const Contour>);

}  // namespace selvedge

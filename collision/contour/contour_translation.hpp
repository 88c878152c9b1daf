#pragma once

#include <span>
#include <vector>

#include "collision/contour/contour.hpp"

namespace selvedge {

// How the two sides of a contour would have to move against each other for it to become shorter: minus the
// translational gradient of its length (contour_energy.hpp), averaged over its crossings (Volino and Magnenat-Thalmann
// 2006).
struct ContourTranslation {
  Vec3 mean = Vec3::Zero();  // of side 0 relative to side 1, no unit; shorter than 1 where the crossings disagree
  std::vector<Vec3> local;   // at each of the contour's points, averaged with neighbours; zero at loop vertices
};

// The contour must be one of those that find_contours makes of the segments.
ContourTranslation contour_translation(std::span<const SheetView> sheets, const Segments&, const Contour&);

}  // namespace selvedge

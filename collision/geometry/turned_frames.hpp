#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// How the surface turns at each vertex between two poses: the rotation that takes the vertex's frame before to that
// after. A frame is the area-weighted normal and the direction of the first edge, made perpendicular to it. The
// identity where a pose is not finite there or has no frame: vertices without area round them.
std::vector<Mat3> turned_frames(const Surface&, const Points& before, const Points& after);

// The turn about the vertical (y) that brings points nearest to others, both about their means. Rows that are not
// finite in one of them are left out. The identity where no turn is nearer than another.
Mat3 turn_about_vertical(const Points& from, const Points& to);

}  // namespace selvedge

#pragma once

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Measures that papers print, by their names and as their code computes them (docs/comparison.md). All measure one
// frame; for a run take the mean over frames.

// l2_mm: mean over the vertices of |x - x*| [mm] (LayersNet, EUNet, GVPM). Both must have the same number of rows.
double l2_mm(const Points& x, const Points& reference);

// e3d: |X - X*| / |X*|, Frobenius norms (FNOpt). It depends on where the origin is.
double e3d(const Points& x, const Points& reference);

// collision_percent: percent of the vertices behind the body's nearest vertex p, (x - p) . n < 0, at any distance, with
// the area-weighted normal n (LayersNet, EUNet). It is looser than the audit: the nearest vertex need not be of the
// nearest face. 0 without a body.
double collision_percent(const Surface& body, const Points& body_x, const Points& x);

// static_share: percent of the vertices that moved by no more than 0.3 mm in the frame, the threshold of
// GarmentCodeData.
double static_share(const Points& before, const Points& x);

}  // namespace selvedge

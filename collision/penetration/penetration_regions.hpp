#pragma once

#include <span>
#include <vector>

#include "collision/contour/contour.hpp"
#include "collision/penetration/open_contours.hpp"
#include "collision/penetration/part_surface.hpp"

namespace selvedge {

// Which contours are judged together. single: each alone (Liao et al. 2024, section 3.2.3). parity: all between the
// same two components, so that what lies between two of them is told from what lies beyond; those that cross others so
// that there is no parity stay alone.
enum class RegionRule { single, parity };

struct PenetrationOptions {
  RegionRule regions = RegionRule::parity;
  SmallerSide smaller = SmallerSide::faces;
};

// A volume that patches of the surface enclose between contours. The patches' signs come from the contours, along which
// those on both sides must run against each other; so they make a closed surface.
struct PenetrationRegion {
  std::vector<int> contours;
  std::vector<ClippedFace> faces;         // with the patch's sign in the moments
  std::vector<ClippedPiece> pieces;       // of the faces that contours run through; their sums are the faces above
  std::vector<int> vertices;              // inside, of all patches
  std::optional<ContourClosing> closing;  // of the contour, if it is open: it then is the only one
  Vec3 centre = Vec3::Zero();             // mean of the crossings [m]
  double volume = 0;                      // [m^3]; its sign says which way the patches are turned
  double area = 0;                        // of the patches [m^2]
};

// What became of a contour.
enum class ContourVolume {
  enclosed,        // it bounds a region
  open,            // it ends where close_open_contour does not close it, or what it bounds goes on to a boundary
  not_orientable,  // on a surface without an inside
  unassigned       // it does not part its surface
};

struct Penetration {
  std::vector<PenetrationRegion> regions;
  std::vector<ContourVolume> contours;  // of each contour
  std::vector<Crossing> crossings;      // those of the segments, behind them those of the closings
};

// The segments of a closed surface with itself that count: a fan meets only its own garment.
Segments penetration_segments(const ClosedSurface&, const Segments& all);

// The regions of a closed surface at `closed_x` (closed_positions), all finite, from its segments that count and their
// contours (trace_contours). Signs are exact up to here; volumes are double, relative to the region's centre.
Penetration find_penetration(const ClosedSurface&, const Points& closed_x, const Segments&,
                             std::span<const Contour> contours, const PenetrationOptions& = {});

// All in one: for who needs neither segments nor contours. They are given back where asked for.
Penetration find_penetration(const ClosedSurface&, const Points& closed_x, const PenetrationOptions& = {},
                             Segments* segments = nullptr);

}  // namespace selvedge

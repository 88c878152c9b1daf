#pragma once

#include <span>
#include <vector>

#include "collision/contour/contour.hpp"
#include "collision/penetration/open_contours.hpp"
#include "collision/penetration/part_surface.hpp"

namespace selvedge {

// Which contours are judged together. single: each alone (Liao et al. 2024, section 3.2.3). parity: all between the
// same two components, so that the area between two of them is told from the area beyond; contours that cross others so
// that no parity exists are judged alone.
enum class RegionRule { single, parity };

// How contours bound volumes. Members are described where keys are bound to them:
// pipeline/training/objective_options.cpp.
struct PenetrationOptions {
  RegionRule regions = RegionRule::parity;
  SmallerSide smaller = SmallerSide::faces;
};

// A volume that patches of the surface enclose between contours. Each patch has a sign, such that two patches that
// share a contour run along it in opposite directions: together they form a closed surface.
struct PenetrationRegion {
  std::vector<int> contours;
  std::vector<ClippedFace> faces;         // moments include the patch's sign
  std::vector<ClippedPiece> pieces;       // of the faces that contours run through; they sum to the entries in `faces`
  std::vector<int> vertices;              // inside the patches
  std::optional<ContourClosing> closing;  // if the contour is open; it then is the only contour
  Vec3 centre = Vec3::Zero();             // mean of the crossings [m]
  double volume = 0;                      // [m^3]; its sign says which way the patches are turned
  double area = 0;                        // of all patches [m^2]
};

// How a contour was used.
enum class ContourVolume {
  enclosed,        // it bounds a region
  open,            // close_open_contour does not close it, or the part that it bounds reaches a boundary
  not_orientable,  // on a surface without an inside
  unassigned       // it does not cut its surface
};

struct Penetration {
  std::vector<PenetrationRegion> regions;
  std::vector<ContourVolume> contours;  // how each was used
  std::vector<Crossing> crossings;      // those of the segments, then those of the closings
};

// Those of all self-intersection segments that count: of a fan only those with its own garment.
Segments penetration_segments(const ClosedSurface&, const Segments& all);

// The regions of a closed surface at `closed_x` (closed_positions; all finite), from penetration_segments and their
// contours (trace_contours). Signs of the input are exact; volumes are double, relative to the region's centre.
Penetration find_penetration(const ClosedSurface&, const Points& closed_x, const Segments&,
                             std::span<const Contour> contours, const PenetrationOptions& = {});

// The same, but finds segments and contours itself. The segments are returned in `segments` if it is given.
Penetration find_penetration(const ClosedSurface&, const Points& closed_x, const PenetrationOptions& = {},
                             Segments* segments = nullptr);

}  // namespace selvedge

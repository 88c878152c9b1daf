#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "collision/penetration/clipped_faces.hpp"

namespace selvedge {

// What makes a side of a curve the smaller one, and so the inside: the number of whole faces (the paper; equal numbers
// are decided by the area), or the area.
enum class SmallerSide { faces, area };

// A query's surface, and memory that its parts share.
struct PartingSpace {
  const ClosedSurface& closed;
  const Points& x;  // closed_positions
  const std::vector<Crossing>& crossings;
  SmallerSide smaller = SmallerSide::faces;
  std::vector<int> owner, count;       // of each vertex: -1, 0
  std::vector<char> shut, cut;         // of each edge, of each triangle: 0
  std::vector<double> component_area;  // [m^2]; empty until one is asked for

  PartingSpace(const ClosedSurface&, const Points&, const std::vector<Crossing>&, SmallerSide);
};

// A component parted by curves together: where an odd number of curves lies between a place and the larger part of it,
// it is inside. Inside, curves bound patches.
struct PartedTogether {
  std::vector<int> inside;                       // of each curve: +1 if its left is inside, -1 if its right is
  std::vector<int> patch;                        // of each curve: the patch inside
  std::vector<std::vector<int>> patch_vertices;  // of each patch
};

// Nothing if the curves do not part the component so, which curves that cross each other need not do; `culprits` then
// has those, as places in `curves`, that have the same part on both sides. All curves lie on one component.
std::optional<PartedTogether> part_together(PartingSpace&, std::span<const SurfaceCurve* const> curves,
                                            std::vector<int>& culprits);

// How often a single curve, which may cross itself, winds round each vertex: 0 in the larger part. Nothing if it does
// not part the component.
std::optional<std::vector<std::pair<int, int>>> part_alone(PartingSpace&, const SurfaceCurve&);

}  // namespace selvedge

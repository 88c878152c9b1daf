#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "collision/penetration/clipped_faces.hpp"

namespace selvedge {

// Which side of a curve is the smaller one, and so the inside: by the number of whole faces (the paper's rule; the area
// decides between equal numbers), or by area.
enum class SmallerSide { faces, area };

// The surface of a query, and memory that calls share.
struct PartingSpace {
  const ClosedSurface& closed;
  const Points& x;  // closed_positions
  const std::vector<Crossing>& crossings;
  SmallerSide smaller = SmallerSide::faces;
  std::vector<int> owner, count;       // of each vertex: -1, 0 between calls
  std::vector<char> shut, cut;         // of each edge, of each triangle: 0 between calls
  std::vector<double> component_area;  // [m^2]; empty until needed

  PartingSpace(const ClosedSurface&, const Points&, const std::vector<Crossing>&, SmallerSide);
};

// A component cut by several curves together. A place is inside if an odd number of curves lies between it and the
// larger part. The curves bound the patches of which the inside consists.
struct PartedTogether {
  std::vector<int> inside;                       // of each curve: +1 if its left is inside, -1 if its right is
  std::vector<int> patch;                        // of each curve: the patch on its inner side
  std::vector<std::vector<int>> patch_vertices;  // of each patch
};

// All curves must lie on one component. Returns nothing if they do not cut it into an inside and an outside, as may
// happen where curves cross each other; `culprits` then lists those (indices in `curves`) with the same part on both
// sides.
std::optional<PartedTogether> part_together(PartingSpace&, std::span<const SurfaceCurve* const> curves,
                                            std::vector<int>& culprits);

// How often a single curve, which may cross itself, winds round each vertex, as (vertex, number); 0 in the larger part,
// which is not listed. Nothing if it does not cut the component.
std::optional<std::vector<std::pair<int, int>>> part_alone(PartingSpace&, const SurfaceCurve&);

}  // namespace selvedge

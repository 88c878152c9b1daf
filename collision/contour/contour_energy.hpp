#pragma once

#include <span>
#include <vector>

#include "collision/contour/segments.hpp"

namespace selvedge {

// translational: only the part that slides crossings along their edges, as if these stayed in place. full: the
// derivative of the value.
enum class ContourGradient { translational, full };

// turning: the face's normal follows its corners. frozen: it is held, and a face moves its crossings through its
// centroid alone, as in ContourCraft's released code (parity README, 25); then neither gradient is the derivative of
// the value.
enum class ContourNormal { turning, frozen };

// What the energy sums over the segments: the squares of their lengths (Grigorev et al. 2024, equation 11), or the
// lengths (Volino and Magnenat-Thalmann 2006).
enum class ContourMeasure { squared_length, length };

// Sum over the segments, [m^2] or [m]. A crossing of edge AB and a face with the corners D_i and normal n is A + s (B -
// A) with
//   s = n.(D - A) / n.(B - A),  ds/dA = -(1 - s) n / n.(B - A),  ds/dB = -s n / n.(B - A),  ds/dD_i = w_i n / n.(B - A)
// where D is the point w.D of the face that the edge crosses (the appendix of the paper has another factor in its
// equation 20, a misprint). With a frozen normal every w_i is a third. Ends at loop vertices are held in the
// translational gradient and follow the vertex in the full one. Segments with an undefined end (the edge lies in the
// plane of the face) are left out. If `gradient` is given it gets one n x 3 matrix for each sheet: the derivative of
// the value by the vertices' positions [m or 1]. Positions may have moved since the segments were found, as long as the
// same edges cross the same faces: the crossings are computed anew.
double contour_energy(std::span<const SheetView> sheets, const Segments& segments,
                      ContourMeasure measure = ContourMeasure::squared_length, std::vector<Points>* gradient = nullptr,
                      ContourGradient kind = ContourGradient::translational,
                      ContourNormal normal = ContourNormal::turning);

}  // namespace selvedge

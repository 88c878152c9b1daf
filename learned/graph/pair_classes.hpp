#pragma once

#include <vector>

#include "collision/contour/contour.hpp"
#include "learned/graph/cloth_pairs.hpp"
#include "learned/graph/feature_options.hpp"

namespace selvedge {

// Cloth-cloth pairs told apart by intersection contours.
struct PairClasses {
  std::vector<ClothPair> repulsion, attraction;
  int contours = 0;           // of the cloth with itself
  int nested = 0;             // sides of contours that lie inside another, which count for nothing
  int enclosed_vertices = 0;  // by a contour side that is not nested
  int without_contour = 0;    // pairs left out: the vertex is enclosed, and its face has no contour with it
};

// ContourRule::vertex, the released code (parity README, 22): a pair attracts if its vertex is enclosed, or lies on
// contours of which none encloses anything; if it is enclosed and the face has no contour in common with it, the pair
// is left out. ContourRule::all_vertices, algorithm 2 of Grigorev et al. 2024: a pair attracts if one of its four
// vertices is enclosed or lies on a contour that encloses nothing; none is left out. With ContourRule::all_repel, or
// without contours, all repel. `cloth` is the only sheet that the contours are of; the order of the pairs stays.
PairClasses classify_pairs(const std::vector<ClothPair>&, const SheetView& cloth, const Segments&,
                           const std::vector<Contour>&, ContourRule);

}  // namespace selvedge

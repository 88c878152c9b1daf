#pragma once

#include <vector>

#include "collision/contour/contour.hpp"
#include "learned/graph/cloth_pairs.hpp"
#include "learned/graph/feature_options.hpp"

namespace selvedge {

// Cloth-cloth pairs, classified by intersection contours.
struct PairClasses {
  std::vector<ClothPair> repulsion, attraction;
  int contours = 0;           // number of contours of the cloth with itself
  int nested = 0;             // sides of contours inside another side, which are ignored
  int enclosed_vertices = 0;  // vertices inside a side that is not nested
  int without_contour = 0;    // pairs left out: the vertex is enclosed, and shares no contour with its face
};

// ContourRule::vertex, the released code (parity README, 22): a pair attracts if its vertex is enclosed, or lies on
// contours of which none encloses anything. It is left out if the vertex is enclosed and shares no contour with the
// face. ContourRule::all_vertices (Grigorev et al. 2024, algorithm 2): a pair attracts if one of its four vertices is
// enclosed or lies on a contour that encloses nothing, and none is left out. With ContourRule::all_repel or without
// contours all repel. `cloth` is the only sheet of the contours. Pairs keep their order.
PairClasses classify_pairs(const std::vector<ClothPair>&, const SheetView& cloth, const Segments&,
                           const std::vector<Contour>&, ContourRule);

}  // namespace selvedge

#pragma once

#include <vector>

#include "collision/contour/segments.hpp"
#include "collision/search/quiet.hpp"
#include "learned/graph/face_frames.hpp"

namespace selvedge {

// A vertex that projects into a face nearby. The edge leads from it to `nearest`, a vertex of the face.
struct ClothPair {
  int vertex = 0, face = 0, nearest = 0;
  int label = 0;      // 0: now; 1: where pinned vertices will be
  double height = 0;  // distance from the face's plane [m]
};

// Memory between frames. It saves time and does not change the result.
struct ClothSearch {
  KeptBvh faces;  // tree of the faces at x
  QuietParts parts;
  KeptBvh prisms, vertices;
  std::vector<Box> boxes;
  std::vector<FrameLeaf> frames;
  PartLists<ClothPair> lists;
};

// The cloth as the search for contours takes it, with a tree of its faces and their quiet parts.
SheetView refreshed_sheet(const Surface&, const Points& x, ClothSearch&);

// All pairs of one of the vertices and a face without it, where the vertex is at most `radius` [m] from the face's
// plane and projects into the face (Grigorev et al. 2024, algorithm 1; parity README, 20). Sorted by vertex and face.
// Two vertices may form several pairs.
std::vector<ClothPair> find_cloth_pairs(const Surface&, const Points& x, const std::vector<int>& vertices,
                                        double radius, ClothSearch&);

// Keeps the `most` pairs with the smallest heights, in their order. Returns how many it drops.
int keep_nearest_pairs(std::vector<ClothPair>&, std::size_t most);

}  // namespace selvedge

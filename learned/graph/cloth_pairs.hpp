#pragma once

#include <vector>

#include "collision/contour/segments.hpp"
#include "collision/search/quiet.hpp"
#include "learned/graph/face_frames.hpp"

namespace selvedge {

// A vertex that projects into a face nearby. The edge leads from it to `nearest`, a vertex of the face.
struct ClothPair {
  int vertex = 0, face = 0, nearest = 0;
  int label = 0;      // 0 now, 1 where pinned vertices will be
  double height = 0;  // distance from the face's plane [m]
};

// Kept between frames. It saves time and does not change what is found.
struct ClothSearch {
  KeptBvh faces;  // where they are
  QuietParts parts;
  KeptBvh prisms, vertices;
  std::vector<Box> boxes;
  std::vector<FrameLeaf> frames;
  PartLists<ClothPair> lists;
};

// The cloth as a search for contours takes it, with a tree of its faces and their quiet parts.
SheetView refreshed_sheet(const Surface&, const Points& x, ClothSearch&);

// All pairs of one of the vertices with a face that does not have it, where the vertex is at most `radius` [m] from the
// face's plane and projects into the face (Grigorev et al. 2024, algorithm 1; parity README, 20). Sorted by vertex and
// face; the same two vertices may come more than once.
std::vector<ClothPair> find_cloth_pairs(const Surface&, const Points& x, const std::vector<int>& vertices,
                                        double radius, ClothSearch&);

// Of the pairs only those with the smallest heights are kept, `most` of them, in their order. Returns how many are not.
int keep_nearest_pairs(std::vector<ClothPair>&, std::size_t most);

}  // namespace selvedge

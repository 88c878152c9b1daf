#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"
#include "collision/search/bvh.hpp"

namespace selvedge {

// What was asked for.
struct NearestQuery {
  Triangles triangles;
  Points x, points;
  std::vector<char> left_out;
  double radius = -1;
};

// Kept between calls. It saves time and does not change what is found; the same question again costs next to nothing.
struct NearestFaces {
  NearestQuery query;
  KeptBvh faces, points;
  std::vector<Box> boxes;
  Points centroids;
  std::vector<int> last;  // what was found
};

// For each point the face whose centroid is nearest, the lowest of several; -1 without faces. Faces with a flag in
// `left_out` (empty: none) are not looked at. The result lies in `last`.
const std::vector<int>& nearest_centroids(const Surface&, const Points& x, const std::vector<char>& left_out,
                                          const Points& points, NearestFaces&);

// For each point the face with the nearest point within the radius, the lowest of several; -1 where there is none.
const std::vector<int>& nearest_faces(const Surface&, const Points& x, const std::vector<char>& left_out, double radius,
                                      const Points& points, NearestFaces&);

}  // namespace selvedge

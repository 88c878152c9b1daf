#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"
#include "collision/search/bvh.hpp"

namespace selvedge {

// The last query.
struct NearestQuery {
  Triangles triangles;
  Points x, points;
  std::vector<char> left_out;
  double radius = -1;
};

// Memory between calls. It saves time and does not change the result. To repeat a query costs next to nothing.
struct NearestFaces {
  NearestQuery query;
  KeptBvh faces, points;
  std::vector<Box> boxes;
  Points centroids;
  std::vector<int> last;  // the result
};

// A face's centroid and unit normal, zero without area.
struct CentroidPlane {
  Vec3 centroid, normal;
  bool has_area() const { return normal.squaredNorm() > 0; }
};
CentroidPlane centroid_plane(const Surface&, const Points& x, int face);

// The face with the nearest centroid for each point, the lowest of several; -1 without faces. Faces with a flag in
// `left_out` (empty: none) are ignored. The result lies in `last`.
const std::vector<int>& nearest_centroids(const Surface&, const Points& x, const std::vector<char>& left_out,
                                          const Points& points, NearestFaces&);

// The face with the nearest point within the radius, for each point: the lowest of several, or -1.
const std::vector<int>& nearest_faces(const Surface&, const Points& x, const std::vector<char>& left_out, double radius,
                                      const Points& points, NearestFaces&);

}  // namespace selvedge

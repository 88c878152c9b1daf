#pragma once

#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Saves queries for points that provably stay outside of a closed body. A distance changes by no more than the motions
// of the point and of the body's fastest vertex, and the side does not change before the distance is zero. So a point
// at distance d is asked again only when these motions sum to d.
class OutsideBudget {
 public:
  // Points that have to be asked now, ascending; all points if the number of points or of body vertices has changed. A
  // point that is not finite, or any point if the body is not, has to be asked.
  std::vector<int> due(const Points& points, const Points& body);
  // Sets the distance of a point that was due. If it is zero or less, the point is due again next time.
  void renew(int point, double distance) { left_[static_cast<std::size_t>(point)] = distance; }

 private:
  Points points_, body_;
  std::vector<double> left_;
};

}  // namespace selvedge

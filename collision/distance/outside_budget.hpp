#pragma once

#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Spares points that provably stay outside of a closed body. A distance changes by no more than the point and the
// body's fastest vertex move, and the side does not change before it has come to zero. So a point that was asked at
// distance d is asked again only when it and the body have moved by d.
class OutsideBudget {
 public:
  // Points that have to be asked now, ascending: all of them where the numbers of points or of body vertices have
  // changed. Not finite counts as moved.
  std::vector<int> due(const Points& points, const Points& body);
  // The answer for a point that was due. Not above zero: it is due next time.
  void renew(int point, double distance) { left_[static_cast<std::size_t>(point)] = distance; }

 private:
  Points points_, body_;
  std::vector<double> left_;
};

}  // namespace selvedge

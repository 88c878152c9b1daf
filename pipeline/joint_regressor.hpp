#pragma once

#include <vector>

#include "collision/points.hpp"

namespace selvedge {

// Weights near the given ones that sum to 1 and have their mean at the point, none below zero: the least change in
// squares relative to the weights, without those that fall below zero, until none does. A point that no such weights
// reach, outside the vertices' hull, is missed: whoever gives points of others looks.
void meet(const Points& x, const std::vector<int>& vertices, const Vec3& point, Eigen::VectorXd& weights);

}  // namespace selvedge

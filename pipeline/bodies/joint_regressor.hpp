#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Weights near the given ones that sum to 1 and have their mean at the point, none below zero: the least change in
// squares relative to the weights, without those that fall below zero, until none does. A point that no such weights
// reach, outside the vertices' hull, is missed: whoever gives points of others looks.
void meet(const Points& x, const std::vector<int>& vertices, const Vec3& point, Eigen::VectorXd& weights);

// Where a body's weights and the places of its joints come from, for errors.
struct RegressorFiles {
  std::string weights, places;
};

// The regressor of a body with its joints, parents and skin: each joint as a mean of the vertices that bend there,
// weighted by the product of what they have of the joint and of its parent (of the root: of its children), changed so
// that it meets the joint's place where one is given. Throws Error for a joint that nothing bends at, and for a place
// that lies outside the vertices that bend there.
SkinWeights joint_regressor(const BodyModel&, const std::vector<std::optional<Vec3>>& places, const RegressorFiles&);

}  // namespace selvedge

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Changes weights so that they sum to 1, none is below zero, and the weighted mean of the vertices is the point. Takes
// the least squares change relative to the weights, drops weights that fall below zero, and repeats. For a point
// outside the vertices' hull there are no such weights, and the mean misses it: callers must check.
void meet(const Points& x, const std::vector<int>& vertices, const Vec3& point, Eigen::VectorXd& weights);

// The files of a body's weights and joints, for errors.
struct RegressorFiles {
  std::string weights, places;
};

// The regressor of a body with joints, parents and skin. Each joint is a mean of the vertices that bend there, weighted
// by the product of their weights for the joint and its parent (for the root: its children). If the joint's place is
// given, weights are changed to meet it. Throws Error for a joint at which nothing bends, and for a place outside the
// vertices that bend there.
SkinWeights joint_regressor(const BodyModel&, const std::vector<std::optional<Vec3>>& places, const RegressorFiles&);

// The regressor of a body without shapes, which needs the joints' places alone: weights of any sign, with the least
// norm. Throws Error, naming `where`, for vertices that lie in one plane.
SkinWeights exact_regressor(const Points& x, const Points& joints, const std::string& where);

}  // namespace selvedge

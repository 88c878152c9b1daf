#include "collision/distance/outside_budget.hpp"

#include <cmath>

namespace selvedge {
namespace {

constexpr double rounding = 1 + 1e-9;

}  // namespace

std::vector<int> OutsideBudget::due(const Points& points, const Points& body) {
  const bool known = points_.rows() == points.rows() && body_.rows() == body.rows();
  if (!known) left_.assign(static_cast<std::size_t>(points.rows()), 0);
  double body_motion = 0;
  for (int v = 0; known && v < body.rows(); ++v) {
    const double squared = (body.row(v) - body_.row(v)).squaredNorm();
    if (!(squared <= body_motion)) body_motion = squared;
  }
  body_motion = std::sqrt(body_motion);
  std::vector<int> result;
  for (int i = 0; i < points.rows(); ++i) {
    double& left = left_[static_cast<std::size_t>(i)];
    if (known) left -= rounding * ((points.row(i) - points_.row(i)).norm() + body_motion);
    if (!(left > 0)) result.push_back(i);
  }
  points_ = points;
  body_ = body;
  return result;
}

}  // namespace selvedge

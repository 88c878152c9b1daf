#pragma once

#include <functional>

#include "collision/geometry/points.hpp"

namespace selvedge {

struct Minimised {
  Points x;
  double value = 0;
  int evaluations = 0;
};

// Returns the value of a function and sets its gradient, with rows of zeros for points that may not move.
using FunctionOfPoints = std::function<double(const Points& x, Points& gradient)>;

// The minimum that L-BFGS (Nocedal and Wright 2006, algorithm 7.5) finds from `start`. inverse_diagonal: a diagonal
// preconditioner with one entry per row.
Minimised minimised(const FunctionOfPoints&, const Eigen::VectorXd& inverse_diagonal, const Points& start,
                    int most_evaluations);

}  // namespace selvedge

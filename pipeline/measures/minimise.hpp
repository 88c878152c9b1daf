#pragma once

#include <functional>

#include "collision/geometry/points.hpp"

namespace selvedge {

struct Minimised {
  Points x;
  double value = 0;
  int evaluations = 0;
};

// The value of a function, and its gradient, which has a row of zeros for what may not move.
using FunctionOfPoints = std::function<double(const Points& x, Points& gradient)>;

// The least value that L-BFGS (Nocedal and Wright 2006, algorithm 7.5) finds from `start`, preconditioned by the
// inverse of a diagonal with an entry for each row.
Minimised minimised(const FunctionOfPoints&, const Eigen::VectorXd& inverse_diagonal, const Points& start,
                    int most_evaluations);

}  // namespace selvedge

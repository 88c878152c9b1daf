#pragma once

#include <functional>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

struct Minimised {
  Points x;
  double value = 0;
  int evaluations = 0;
};

// Returns the value of a function and sets its gradient, with rows of zeros for points that may not move.
using FunctionOfPoints = std::function<double(const Points& x, Points& gradient)>;

// The minimum that L-BFGS (Nocedal and Wright 2006, algorithm 7.5) finds from `start`. diagonal: about that of the
// Hessian, with one entry per row. It is the preconditioner; rows without an entry above 0 stay.
Minimised minimised(const FunctionOfPoints&, const std::vector<double>& diagonal, const Points& start,
                    int most_evaluations);

}  // namespace selvedge

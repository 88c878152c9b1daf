#include "pipeline/measures/minimise.hpp"

#include <cmath>
#include <deque>

namespace selvedge {
namespace {

struct CurvaturePair {
  Points s, y;
  double rho = 0;  // 1 / (s . y)
};

double dot(const Points& a, const Points& b) { return a.cwiseProduct(b).sum(); }

// The two-loop recursion, with the inverse diagonal as first guess of the inverse Hessian.
Points quasi_newton(const std::deque<CurvaturePair>& pairs, const Eigen::VectorXd& inverse_diagonal,
                    const Points& gradient) {
  Points direction = gradient;
  std::vector<double> alpha(pairs.size());
  for (std::size_t k = pairs.size(); k-- > 0;) {
    alpha[k] = pairs[k].rho * dot(pairs[k].s, direction);
    direction -= alpha[k] * pairs[k].y;
  }
  double scale = 1;
  if (!pairs.empty()) {
    const CurvaturePair& last = pairs.back();
    scale = 1 / (last.rho * dot(last.y, inverse_diagonal.asDiagonal() * last.y));
  }
  direction = (scale * inverse_diagonal).asDiagonal() * direction;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    direction += (alpha[k] - pairs[k].rho * dot(pairs[k].y, direction)) * pairs[k].s;
  return direction;
}

}  // namespace

Minimised minimised(const FunctionOfPoints& function, const std::vector<double>& diagonal, const Points& start,
                    int most_evaluations) {
  constexpr std::size_t memory = 12;
  constexpr double sufficient = 1e-4;  // of the slope
  Eigen::VectorXd inverse(start.rows());
  for (int v = 0; v < start.rows(); ++v) inverse[v] = diagonal[v] > 0 ? 1 / diagonal[v] : 0;
  Minimised best{start, 0, 0};
  const auto evaluate = [&](const Points& x, Points& gradient) {
    ++best.evaluations;
    return function(x, gradient);
  };
  Points gradient, next_gradient;
  best.value = evaluate(best.x, gradient);
  std::deque<CurvaturePair> pairs;
  while (best.evaluations < most_evaluations) {
    Points direction = -quasi_newton(pairs, inverse, gradient);
    double slope = dot(direction, gradient);
    if (!(slope < 0)) {
      pairs.clear();
      direction = -(inverse.asDiagonal() * gradient);
      slope = dot(direction, gradient);
      if (!(slope < 0)) break;
    }
    double t = 1, value = 0;
    Points x;
    for (int halvings = 0;; ++halvings) {
      x = best.x + t * direction;
      value = evaluate(x, next_gradient);
      if (value <= best.value + sufficient * t * slope) break;
      if (halvings == 30 || best.evaluations >= most_evaluations) return best;
      t /= 2;
    }
    CurvaturePair pair{x - best.x, next_gradient - gradient, 0};
    const double curvature = dot(pair.s, pair.y), gained = best.value - value;
    best.x = x;
    best.value = value;
    gradient = next_gradient;
    if (curvature > 0) {
      pair.rho = 1 / curvature;
      pairs.push_back(std::move(pair));
      if (pairs.size() > memory) pairs.pop_front();
    }
    if (gained < 1e-9 * std::abs(value)) break;
  }
  return best;
}

}  // namespace selvedge

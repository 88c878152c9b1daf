#include "pipeline/validate/known_answers.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace selvedge {
namespace {

constexpr double pi = std::numbers::pi;

// The root of a function that ascends from below zero at `low` to above it at `high`.
template <class Function>
double root_between(double low, double high, Function function) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Seen from the tip with t = 1 - s and phi = pi / 2 - theta: phi'' = gamma t sin(phi), phi'(0) = 0. By Runge and
// Kutta's fourth-order steps to t = 1, or to where phi passes a right angle for good.
struct FromTip {
  double phi = 0, slope = 0, H = 0, W = 0;
};

FromTip integrate(double gamma, double tip) {
  constexpr int steps = 4000;
  const double h = 1.0 / steps;
  FromTip y{tip, 0, 0, 0};
  const auto rate = [gamma](double t, const FromTip& at) {
    return FromTip{at.slope, gamma * t * std::sin(at.phi), std::cos(at.phi), std::sin(at.phi)};
  };
  const auto plus = [](const FromTip& a, double f, const FromTip& b) {
    return FromTip{a.phi + f * b.phi, a.slope + f * b.slope, a.H + f * b.H, a.W + f * b.W};
  };
  for (int i = 0; i < steps && y.phi < pi; ++i) {
    const double t = i * h;
    const FromTip k1 = rate(t, y), k2 = rate(t + h / 2, plus(y, h / 2, k1)), k3 = rate(t + h / 2, plus(y, h / 2, k2)),
                  k4 = rate(t + h, plus(y, h, k3));
    y = plus(plus(plus(plus(y, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
  }
  return y;
}

}  // namespace

Cantilever elastica(double gamma) {
  assert(gamma > 0);
  // How nearly the tip hangs straight down ranges over hundreds of magnitudes, hence the logarithm.
  const double log_tip = root_between(-600, std::log(pi / 2),
                                      [gamma](double log) { return integrate(gamma, std::exp(log)).phi - pi / 2; });
  const FromTip found = integrate(gamma, std::exp(log_tip));
  return {found.H, found.W};
}

double catenary_sag(double ratio) {
  assert(ratio > 1);
  const double u = root_between(1e-9, 100, [ratio](double z) { return std::sinh(z) / z - ratio; });
  return (std::cosh(u) - 1) / (2 * u);
}

double lateral_buckling_gamma(double nu) { return 12.85 * std::sqrt(2 * (1 - nu * nu) * (1 - nu)); }

double clamped_free_root(int n) {
  assert(n == 1 || n == 2);
  const double sign = n == 1 ? -1 : 1;
  return root_between(n == 1 ? 1.0 : 4.0, n == 1 ? 3.0 : 5.0,
                      [sign](double z) { return sign * (std::cos(z) + 1 / std::cosh(z)); });
}

double clamped_free_mode(double root, double s) {
  const double ratio = (std::cosh(root) + std::cos(root)) / (std::sinh(root) + std::sin(root)), z = root * s;
  const auto shape = [ratio](double at) {
    return std::cosh(at) - std::cos(at) - ratio * (std::sinh(at) - std::sin(at));
  };
  return shape(z) / std::abs(shape(root));
}

}  // namespace selvedge

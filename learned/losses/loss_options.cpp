#include "learned/losses/loss_options.hpp"

#include <algorithm>

namespace selvedge {
namespace {

// A ramp between iterations of a run, as fractions of its length.
LossRamp ramp_over(double from, double to, double begin, double end, double iterations) {
  return {from, to, begin / iterations, end / iterations};
}

}  // namespace

double weight_at(const LossRamp& ramp, double progress) {
  if (progress >= ramp.end) return ramp.to;
  if (progress <= ramp.begin) return ramp.from;
  return ramp.from + (ramp.to - ramp.from) * (progress - ramp.begin) / (ramp.end - ramp.begin);
}

LossOptions hood_losses() {
  LossOptions options;
  options.collision.weight = ramp_over(5e3, 5e5, 50e3, 150e3, 150e3);
  options.friction.weight = {};
  return options;
}

LossOptions contourcraft_losses() {
  LossOptions options;
  options.collision.thickness = 3e-3;
  options.collision.matching = BodyMatching::nearest_face;
  options.collision.weight = ramp_over(5e3, 1e6, 30e3, 40e3, 56e3);
  options.repulsion.weight = ramp_over(0, 2e6, 30e3, 40e3, 56e3);
  return options;
}

LossOptions contourcraft_final_losses() {
  LossOptions options = contourcraft_losses();
  options.collision.weight = {1e6, 1e6};
  options.repulsion.weight = {2e6, 2e6};
  options.contours.weight = ramp_over(0, 1e7, 0, 5e3, 11e3);
  return options;
}

LossOptions fast_losses() {
  LossOptions options;
  options.collision.thickness = 3e-3;
  options.collision.weight = {5e3, 1e6, 0.1, 0.5};
  options.contours.weight = {30, 30};
  return options;
}

}  // namespace selvedge

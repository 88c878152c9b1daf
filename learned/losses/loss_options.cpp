#include "learned/losses/loss_options.hpp"

namespace selvedge {
double weight_at(const LossRamp& ramp, double progress) {
  if (progress >= ramp.end) return ramp.to;
  if (progress <= ramp.begin) return ramp.from;
  return ramp.from + (ramp.to - ramp.from) * (progress - ramp.begin) / (ramp.end - ramp.begin);
}

LossOptions hood_losses() {
  LossOptions options;
  options.collision.weight = {5e3, 5e5, 50.0 / 150, 1};
  options.friction.weight = {};
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

#include "pipeline/training/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace selvedge {

bool reaches_its_end(const LossRamp& ramp) { return ramp.begin <= ramp.end && ramp.end <= 0.9; }

double learning_factor(Decay decay, double progress, long step, long halving_steps, double floor) {
  if (decay == Decay::cosine) return 0.5 * (1 + std::cos(std::numbers::pi * std::clamp(progress, 0.0, 1.0)));
  if (decay == Decay::none) return 1;
  return std::pow(0.5, static_cast<double>(step / std::max(halving_steps, 1L))) + floor;
}

}  // namespace selvedge

#include "learned/repulsion/plain_adam.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {

bool take_step(PlainAdam& adam, std::span<const float> gradient, PlainNetwork& network) {
  if (!std::ranges::all_of(gradient, [](float g) { return std::isfinite(g); })) return false;
  std::vector<float> parameters = parameters_of(network);
  adam.first.resize(parameters.size(), 0);
  adam.second.resize(parameters.size(), 0);
  ++adam.steps;
  const double first_share = 1 - std::pow(adam.beta1, static_cast<double>(adam.steps));
  const double second_share = 1 - std::pow(adam.beta2, static_cast<double>(adam.steps));
  const auto step = static_cast<float>(adam.rate / first_share);
  const auto root = static_cast<float>(1 / std::sqrt(second_share)), epsilon = static_cast<float>(adam.epsilon);
  const auto beta1 = static_cast<float>(adam.beta1), beta2 = static_cast<float>(adam.beta2);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    adam.first[i] = beta1 * adam.first[i] + (1 - beta1) * gradient[i];
    adam.second[i] = beta2 * adam.second[i] + (1 - beta2) * gradient[i] * gradient[i];
    parameters[i] -= step * adam.first[i] / (std::sqrt(adam.second[i]) * root + epsilon);
  }
  set_parameters(parameters, network);
  return true;
}

}  // namespace selvedge

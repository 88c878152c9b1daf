#include "learned/repulsion/plain_adam.hpp"

#include <algorithm>
#include <cmath>

#include "learned/gradients/adam_rule.hpp"

namespace selvedge {

bool take_step(PlainAdam& adam, std::span<const float> gradient, PlainNetwork& network) {
  if (!std::ranges::all_of(gradient, [](float g) { return std::isfinite(g); })) return false;
  std::vector<float> parameters = parameters_of(network);
  adam.first.resize(parameters.size(), 0);
  adam.second.resize(parameters.size(), 0);
  const auto kept = static_cast<float>(1 - adam.rate * adam.decay);
  if (adam.decay > 0)
    for (float& value : parameters) value *= kept;
  const AdamNumbers numbers = adam_numbers(adam.rate, adam.beta1, adam.beta2, adam.epsilon, ++adam.steps);
  take_adam_step(numbers, static_cast<std::ptrdiff_t>(parameters.size()), gradient.data(), adam.first.data(),
                 adam.second.data(), parameters.data());
  set_parameters(parameters, network);
  return true;
}

}  // namespace selvedge

#pragma once

#include <cmath>
#include <cstddef>

namespace selvedge {

// Factors of one step of Adam (Kingma and Ba 2015, algorithm 1), each rounded to float once.
struct AdamNumbers {
  float scale, beta1, rest1, beta2, rest2, step, root, epsilon;  // scale: of the gradient; rest: 1 - beta
};

// `steps` counts from 1.
inline AdamNumbers adam_numbers(double rate, double beta1, double beta2, double epsilon, long long steps,
                                double scale = 1) {
  const auto t = static_cast<double>(steps);
  return {static_cast<float>(scale),
          static_cast<float>(beta1),
          static_cast<float>(1 - beta1),
          static_cast<float>(beta2),
          static_cast<float>(1 - beta2),
          static_cast<float>(rate / (1 - std::pow(beta1, t))),
          static_cast<float>(1 / std::sqrt(1 - std::pow(beta2, t))),
          static_cast<float>(epsilon)};
}

// Updates both moments and the values.
inline void take_adam_step(const AdamNumbers& n, std::ptrdiff_t size, const float* gradient, float* first,
                           float* second, float* values) {
  for (std::ptrdiff_t k = 0; k < size; ++k) {
    const float g = n.scale * gradient[k];
    first[k] = n.beta1 * first[k] + n.rest1 * g;
    second[k] = n.beta2 * second[k] + n.rest2 * g * g;
    values[k] -= n.step * first[k] / (std::sqrt(second[k]) * n.root + n.epsilon);
  }
}

}  // namespace selvedge

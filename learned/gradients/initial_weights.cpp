#include "learned/gradients/initial_weights.hpp"

#include <cmath>
#include <numbers>

#include "learned/network/uniform_numbers.hpp"

namespace selvedge {

NetworkWeights initial_weights(const Architecture& a, std::uint64_t seed, double last_layer_scale) {
  NetworkWeights weights = blank_weights(a);
  UniformNumbers random(seed);
  // Box and Muller 1958. One number of each pair is used.
  const auto normal = [&random] {
    const double radius = std::sqrt(-2 * std::log(random.in_unit())), turn = 2 * std::numbers::pi * random.in_unit();
    return static_cast<float>(radius * std::cos(turn));
  };
  for (const WeightArray& array : weight_arrays(a, weights)) {
    const bool table = array.name.starts_with("embeddings/");
    if (!table && array.inputs == 0) continue;  // layer norms and statistics
    const float bound = table ? 0.f : 1.f / std::sqrt(static_cast<float>(array.inputs));
    for (int i = 0; i < array.rows * array.columns; ++i)
      array.data[i] = table ? normal() : bound * random.in_both_signs();
  }
  AffineLayer& last = weights.decoder.layers.back();
  last.weight *= static_cast<float>(last_layer_scale);
  for (float& bias : last.bias) bias *= static_cast<float>(last_layer_scale);
  return weights;
}

}  // namespace selvedge

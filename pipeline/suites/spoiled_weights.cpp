#include "pipeline/suites/spoiled_weights.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace selvedge {
namespace {

// What the last layer gives, whatever comes in.
void set_output(NetworkWeights& weights, float value) {
  AffineLayer& last = weights.decoder.layers.back();
  last.weight.setZero();
  std::ranges::fill(last.bias, value);
}

}  // namespace

const std::vector<std::string>& weight_faults() {
  static const std::vector<std::string> faults{"nan", "random", "zero", "huge"};
  return faults;
}

WeightFile spoiled_weights(WeightFile file, const std::string& fault) {
  assert(std::ranges::count(weight_faults(), fault) == 1);
  if (fault == "nan") set_output(file.weights, std::numeric_limits<float>::quiet_NaN());
  if (fault == "zero") set_output(file.weights, 0);
  if (fault == "huge") set_output(file.weights, 1e6F);
  if (fault == "random") {
    const FeatureTables tables = file.weights.tables;
    file.weights = random_weights(file.architecture, 1);
    file.weights.tables = tables;
  }
  return file;
}

}  // namespace selvedge

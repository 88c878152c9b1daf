#pragma once

#include <string>
#include <vector>

#include "learned/gradients/training_network.hpp"

namespace selvedge {

// Kingma and Ba 2015, algorithm 1, with bias correction.
struct AdamOptions {
  double learning_rate = 1e-3;
  double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-8;
  double clip_norm = 0;    // largest norm of the gradient; 0: no limit
  double clip_median = 0;  // largest norm in medians of the last steps' norms; 0: no limit
};

// The state between steps. Moments have the shapes of the weights.
struct AdamState {
  long long steps = 0;
  NetworkWeights first, second;
  std::vector<float> norms;  // of the last gradients, the oldest first; at most `median_window`
};
constexpr std::size_t median_window = 101;

// Zero moments in the architecture's shapes.
AdamState start_adam(const Architecture&);

struct AdamReport {
  bool taken = true;  // false: the gradient is not finite, and nothing has changed
  double learning_rate = 0;
  double norm = 0;   // gradient norm over all trained arrays
  double scale = 1;  // factor of the gradient
};

// Takes one step. Call `lay_out` afterwards. 1 and n threads give the same bits. Throws Error where shapes differ.
AdamReport adam_step(const Architecture&, const AdamOptions&, const WeightGradients&, AdamState&, NetworkWeights&);

// A state as plain arrays, for a checkpoint: "adam/first/ARRAY", "adam/second/ARRAY" for each trained array
// (`weight_arrays`), "adam/steps" (two numbers, high and low), "adam/norms". Training that continues from a checkpoint
// gives the same bits.
struct NamedFloats {
  std::string name;
  std::vector<float> values;
};
std::vector<NamedFloats> adam_arrays(const Architecture&, const AdamState&);
// Throws Error that names an array which is missing, duplicate, unknown or of another size. `where` names the file.
AdamState adam_from_arrays(const Architecture&, const std::vector<NamedFloats>&, const std::string& where);

}  // namespace selvedge

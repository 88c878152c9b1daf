#pragma once

#include <string>

#include "learned/network/weights_hdf5.hpp"

namespace selvedge {

// The content of a weight file, for people and programs.
struct WeightsInfo {
  WeightFile file;                          // without its weights
  long long parameters = 0, nonfinite = 0;  // trainable numbers; weights and statistics that are not finite
  int constant_columns = 0;                 // columns whose deviation is the floor of 1e-8
};

// Counts parameters, numbers that are not finite and constant columns.
WeightsInfo weights_info(const WeightFile&);
std::string weights_info_text(const WeightsInfo&);
std::string weights_info_json(const WeightsInfo&);

}  // namespace selvedge

#pragma once

#include <cmath>

#include "learned/network/simd_vector.hpp"

namespace selvedge {

// Finds mean and factor of the layer norm (x - mean) * factor * scale + shift. Epsilon is 1e-5, as in the published
// networks. Several rows at once overlap their chains of sums.
template <int Lanes, int Rows>
[[gnu::always_inline]] inline void find_norms(const float* values, std::ptrdiff_t stride, int columns, float* mean,
                                              float* factor) {
  const int whole = columns / Lanes * Lanes;
  Vector<Lanes> sums[Rows] = {};
  for (int k = 0; k < whole; k += Lanes) {
    SELVEDGE_UNROLL
    for (int r = 0; r < Rows; ++r) sums[r] += load_vector<Lanes>(values + r * stride + k);
  }
  SELVEDGE_UNROLL
  for (int r = 0; r < Rows; ++r) {
    mean[r] = sum_lanes<Lanes>(sums[r]);
    for (int k = whole; k < columns; ++k) mean[r] += values[r * stride + k];
    mean[r] /= static_cast<float>(columns);
    sums[r] = Vector<Lanes>{};
  }
  for (int k = 0; k < whole; k += Lanes) {
    SELVEDGE_UNROLL
    for (int r = 0; r < Rows; ++r) {
      const Vector<Lanes> off = load_vector<Lanes>(values + r * stride + k) - mean[r];
      sums[r] += off * off;
    }
  }
  SELVEDGE_UNROLL
  for (int r = 0; r < Rows; ++r) {
    float variance = sum_lanes<Lanes>(sums[r]);
    for (int k = whole; k < columns; ++k) {
      const float off = values[r * stride + k] - mean[r];
      variance += off * off;
    }
    factor[r] = 1.f / std::sqrt(variance / static_cast<float>(columns) + 1e-5f);
  }
}

}  // namespace selvedge

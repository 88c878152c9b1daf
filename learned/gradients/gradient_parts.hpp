#pragma once

#include <vector>

#include "learned/network/latent_rows.hpp"
#include "learned/network/weights.hpp"

namespace selvedge {

// Derivatives of some arrays of weights while they are summed up: each part of the work has its own sums, so that
// several threads give the same bits; then the parts are added up in their order.
class GradientParts {
 public:
  // Forgets what was there. Memory is kept.
  void begin(int parts);
  // Columns [begin, begin + columns) of a matrix, or a whole vector. Returns its place in each part.
  int add(FeatureRows& gradient, Eigen::Index begin, Eigen::Index columns);
  int add(std::vector<float>& gradient);
  void allocate();
  // Zeros one part and gives it: to be called by the thread that fills it.
  float* start(int part);
  // Adds all parts to the gradients.
  void finish();

 private:
  // `rows` rows of padded floats in each part.
  struct Piece {
    int place, rows, columns;
    float* to;
    std::ptrdiff_t to_stride;
  };
  int append(int rows, int columns, float* to, std::ptrdiff_t to_stride);

  int parts_ = 0, size_ = 0;
  std::vector<Piece> pieces_;
  AlignedFloats floats_;
};

}  // namespace selvedge

#pragma once

#include <vector>

#include "learned/network/latent_rows.hpp"
#include "learned/network/weights.hpp"

namespace selvedge {

// Sums up derivatives of arrays of weights. Each part of the work has its own sums, and they are added in the
// order of the parts at the end. So any number of threads gives the same bits.
class GradientParts {
 public:
  // Forgets all arrays and keeps the memory.
  void begin(int parts);
  // Adds columns [begin, begin + columns) of a matrix, or a vector. Returns its place in each part.
  int add(FeatureRows& gradient, Eigen::Index begin, Eigen::Index columns);
  int add(std::vector<float>& gradient);
  void allocate();
  // Zeros one part and returns it. The thread that fills the part calls this.
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

#include "learned/gradients/gradient_parts.hpp"

#include <algorithm>

namespace selvedge {

void GradientParts::begin(int parts) {
  parts_ = parts;
  size_ = 0;
  pieces_.clear();
}

int GradientParts::append(int rows, int columns, float* to, std::ptrdiff_t to_stride) {
  const int place = size_;
  pieces_.push_back({place, rows, columns, to, to_stride});
  size_ += padded(rows) * padded(columns);
  return place;
}

int GradientParts::add(FeatureRows& gradient, Eigen::Index begin, Eigen::Index columns) {
  return append(static_cast<int>(gradient.rows()), static_cast<int>(columns), gradient.data() + begin, gradient.cols());
}

int GradientParts::add(std::vector<float>& gradient) {
  const int place = size_;
  pieces_.push_back({place, 1, static_cast<int>(gradient.size()), gradient.data(), 0});
  size_ += padded(static_cast<int>(gradient.size()));
  return place;
}

void GradientParts::allocate() {
  const std::size_t wanted = static_cast<std::size_t>(parts_) * static_cast<std::size_t>(size_);
  if (floats_.size() < wanted) floats_ = AlignedFloats(wanted);
}

float* GradientParts::start(int part) {
  float* floats = floats_.data() + static_cast<std::ptrdiff_t>(part) * size_;
  std::fill_n(floats, size_, 0.f);
  return floats;
}

void GradientParts::finish() {
  int rows = 0;
  for (const Piece& piece : pieces_) rows += piece.rows;
#pragma omp parallel for schedule(static)
  for (int row = 0; row < rows; ++row) {
    int r = row;
    const Piece* piece = pieces_.data();
    for (; r >= piece->rows; ++piece) r -= piece->rows;
    float* sum = floats_.data() + piece->place + static_cast<std::ptrdiff_t>(r) * padded(piece->columns);
    for (int part = 1; part < parts_; ++part) {
      const float* more = sum + static_cast<std::ptrdiff_t>(part) * size_;
      for (int k = 0; k < piece->columns; ++k) sum[k] += more[k];
    }
    float* to = piece->to + r * piece->to_stride;
    for (int k = 0; k < piece->columns; ++k) to[k] += sum[k];
  }
}

}  // namespace selvedge

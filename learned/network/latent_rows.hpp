#pragma once

#include "collision/geometry/parallel.hpp"
#include "learned/network/aligned_floats.hpp"
#include "learned/network/engine_kernels.hpp"

namespace selvedge {

inline int tiles_of(int rows, int tile = tile_rows) { return chunks_of(rows, tile); }

// One row per node, edge or sum, padded with zeros. Kernels can read and write a whole tile from any row.
struct LatentRows {
  int stride = 0;
  AlignedFloats values;

  LatentRows() = default;
  LatentRows(int rows, int columns) { reshape(rows, columns); }
  // The content is undefined afterwards. Memory is kept if it suffices.
  void reshape(int rows, int columns) {
    const std::size_t size = static_cast<std::size_t>(tiles_of(rows) * tile_rows) * padded(columns);
    if (stride != padded(columns) || values.size() < size) values = AlignedFloats(size);
    stride = padded(columns);
  }
  float* row(int i) { return values.data() + static_cast<std::ptrdiff_t>(i) * stride; }
  const float* row(int i) const { return values.data() + static_cast<std::ptrdiff_t>(i) * stride; }
};

// Prefetches a row.
inline void prefetch_row(const float* row, int columns) {
  for (int k = 0; k < columns; k += 16) __builtin_prefetch(row + k, 0, 2);
}

}  // namespace selvedge

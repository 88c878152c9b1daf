#pragma once

#include "learned/network/engine_kernels.hpp"

namespace selvedge {

// Rows of a tile, which passes through all layers of a perceptron at once: whole register blocks of every set.
constexpr int training_rows = 48;

// The end of a perceptron's forward pass. Row r of `values` becomes (x - mean) / deviation, and factor[r] becomes 1 /
// deviation; without `scale` both stay. Then latent = from + result, or the result where `from` is null, and sum +=
// result. Epsilon is 1e-5.
struct NormTile {
  float* values = nullptr;
  int stride = 0, columns = 0, rows = 0;
  const float *scale = nullptr, *shift = nullptr;
  float* factor = nullptr;  // one per row
  const float* const* from = nullptr;
  float* const* latent = nullptr;
  float* const* sum = nullptr;  // may be null
};

// The backward pass of the layer norm. Row r of `d` is the derivative by the result and becomes that by the values.
// Adds to the derivatives of scale and shift.
struct NormBackTile {
  float* d = nullptr;
  int stride = 0, columns = 0, rows = 0;
  const float* values = nullptr;  // as NormTile left them
  int values_stride = 0;
  const float* factor = nullptr;
  const float* scale = nullptr;
  float *d_scale = nullptr, *d_shift = nullptr;
};

// out += sum of outer products a_r b_r, and bias += sum of a_r. These are derivatives by weights and biases of a layer,
// if a has those by its results and b its inputs. Columns are padded to whole panels.
struct OuterTile {
  const float* a = nullptr;
  int a_stride = 0, a_columns = 0;
  const float* const* b = nullptr;  // one pointer per row
  int b_columns = 0;
  float* out = nullptr;   // a_columns x b_columns
  float* bias = nullptr;  // may be null
  int rows = 0;
};

// to_r += from_r, row by row in this order; rows of `to` may be the same. Columns are padded.
struct AddTile {
  const float* from = nullptr;
  int stride = 0, columns = 0, rows = 0;
  float* const* to = nullptr;
};

// to = sum of the rows `slots` of `from`, in this order. Columns are padded.
struct SumTile {
  const float* from = nullptr;
  int stride = 0;
  const int* slots = nullptr;
  int rows = 0, columns = 0;
  float* to = nullptr;
};

struct TrainingKernels {
  void (*norm)(const NormTile&);
  void (*norm_back)(const NormBackTile&);
  void (*outer)(const OuterTile&);
  void (*add)(const AddTile&);
  void (*sum)(const SumTile&);
};

// Throws Error where the machine does not have the set.
const TrainingKernels& training_kernels_for(InstructionSet);

}  // namespace selvedge

#pragma once

#include "learned/network/instruction_set.hpp"

namespace selvedge {

// Rows that pass forward and back through all layers of a perceptron at a time: whole register blocks of every set.
constexpr int training_rows = 48;

// The end of a perceptron's forward pass: row r of `values` becomes (x - mean) / deviation, and `factor` of it 1 /
// deviation; without `scale` it stays. Then latent = from + result, or the result where `from` is null, and sum +=
// result. Epsilon 1e-5.
struct NormTile {
  float* values = nullptr;
  int stride = 0, columns = 0, rows = 0;
  const float *scale = nullptr, *shift = nullptr;
  float* factor = nullptr;  // one a row
  const float* const* from = nullptr;
  float* const* latent = nullptr;
  float* const* sum = nullptr;  // may be null
};

// The layer norm backward: row r of `d` goes from the derivative with respect to the result to that with respect to the
// values. Adds to the derivatives of scale and shift.
struct NormBackTile {
  float* d = nullptr;
  int stride = 0, columns = 0, rows = 0;
  const float* values = nullptr;  // as NormTile left them
  int values_stride = 0;
  const float* factor = nullptr;
  const float* scale = nullptr;
  float *d_scale = nullptr, *d_shift = nullptr;
};

// out += sum of outer products a_r b_r, and bias += sum of a_r: the weights of a layer, whose results have derivatives
// a and whose inputs are b. Columns are padded to whole panels.
struct OuterTile {
  const float* a = nullptr;
  int a_stride = 0, a_columns = 0;
  const float* const* b = nullptr;  // one pointer a row
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

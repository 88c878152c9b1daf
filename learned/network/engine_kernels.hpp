#pragma once

#include "learned/network/instruction_set.hpp"

namespace selvedge {

// Rows of activations that pass all layers of a perceptron while they lie in the cache.
constexpr int tile_rows = 24;
// Rows of floats are padded with zeros to a multiple of this many: whole panels for every instruction set.
constexpr int padding = 32;

inline int padded(int columns) { return (columns + padding - 1) / padding * padding; }

// One layer on one tile: out = [max(0, .)] (start + input x weight), where start is the bias, or what `out` holds. Of
// `input` and `out` whole register blocks are read and written: `input` has tile_rows entries that can be read, `out`
// has tile_rows rows.
struct LayerTile {
  const float* const* input = nullptr;  // one pointer a row
  int inputs = 0;
  const float* weight = nullptr;  // panels of outputs, one after the other; in a panel, one row an input
  const float* bias = nullptr;    // padded
  float* out = nullptr;
  int stride = 0;                      // of `out`
  int outputs = 0;                     // padded to whole panels
  const float* next_weight = nullptr;  // what will be read after this layer; only fetched
  int rows = 0;                        // one at least
  bool go_on = false;                  // start from what `out` holds
  bool rectify = false;
  const float* mask = nullptr;  // results become zero where it is not above zero; null: none do
  int mask_stride = 0;
};

// out = a + b, row by row: the products of an edge's two nodes.
struct PairTile {
  const float* const* a = nullptr;
  const float* const* b = nullptr;
  float* out = nullptr;
  int stride = 0, columns = 0, rows = 0;  // columns: padded
};

// What happens to the results of a perceptron: layer norm where it has one, then `latent` = or += result, `sum` += it.
struct ResultTile {
  const float* values = nullptr;
  int stride = 0, columns = 0, rows = 0;
  const float* scale = nullptr;  // no layer norm where it is null
  const float* shift = nullptr;
  float* const* latent = nullptr;
  bool add = false;
  float* const* sum = nullptr;  // may be null
};

// The inner loops, compiled for one instruction set.
struct EngineKernels {
  int panel;  // outputs in a panel
  int lanes;  // floats in a vector
  void (*multiply)(const LayerTile&);
  void (*add_pairs)(const PairTile&);
  void (*finish)(const ResultTile&);
  // Twelve independent chains of multiplications with addition, in registers only. The result keeps them alive.
  float (*exercise)(long iterations, float factor);
};
constexpr int exercise_chains = 12;

// Throws Error where the machine does not have the set.
const EngineKernels& kernels_for(InstructionSet);

}  // namespace selvedge

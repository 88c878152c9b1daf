#pragma once

#include <string>

namespace selvedge {

// Instruction sets of the kernels: plain x86-64 (or the machine's own), AVX2 with FMA, AVX-512. Results differ by
// rounding. `vnni` (AVX-512 VNNI) multiplies integers of 16 bits and adds up in 32; it has no kernels for training.
enum class InstructionSet { plain, avx2, avx512, vnni };

bool is_supported(InstructionSet);      // by this machine
InstructionSet best_instruction_set();  // of the supported ones with 32-bit floats
std::string name_of(InstructionSet);

// Rows of activations that pass all layers of a perceptron while they are in the cache.
constexpr int tile_rows = 24;
// Rows of floats are padded with zeros to a multiple of this: whole panels for every instruction set.
constexpr int padding = 32;

// `vnni` reads inputs two at a time, and the last of an odd number with a zero. Inputs are whole numbers up to this;
// the weights of an output are such that no sum leaves 32 bits.
constexpr int largest_input = 16383;
inline int pairs_of(int inputs) { return (inputs + 1) / 2; }

inline int padded(int columns) { return (columns + padding - 1) / padding * padding; }

// One layer on one tile: out = [max(0, .)] (start + input x weight). The start is the bias, or the content of `out`.
// Whole register blocks are read and written: `input` must have tile_rows valid pointers, and `out` tile_rows rows.
struct LayerTile {
  const float* const* input = nullptr;  // one pointer per row
  int inputs = 0;
  const float* weight = nullptr;  // panels of outputs, one after the other; a panel has one row per input, or per pair
  const float* bias = nullptr;    // padded
  const float* unit = nullptr;    // of each output's integer weights, padded; null: weights are floats
  float* out = nullptr;
  int stride = 0;                      // of `out`
  int outputs = 0;                     // padded to whole panels
  const float* next_weight = nullptr;  // weights of the next layer, which are prefetched
  int rows = 0;                        // one at least
  bool go_on = false;                  // start from the content of `out`
  bool rectify = false;
  const float* mask = nullptr;  // results are zero unless the mask is above zero; null: no mask
  int mask_stride = 0;
};

// out = a + b, row by row: the sum of the products of an edge's two nodes.
struct PairTile {
  const float* const* a = nullptr;
  const float* const* b = nullptr;
  float* out = nullptr;
  int stride = 0, columns = 0, rows = 0;  // columns: padded
};

// The end of a perceptron: layer norm if it has one, then `latent` = or += result, and `sum` += result.
struct ResultTile {
  const float* values = nullptr;
  int stride = 0, columns = 0, rows = 0;
  const float* scale = nullptr;  // null: no layer norm
  const float* shift = nullptr;
  float* const* latent = nullptr;
  bool add = false;
  float* const* sum = nullptr;  // may be null
};

// The inner loops, compiled for one instruction set.
struct EngineKernels {
  int panel;   // outputs per panel
  int lanes;   // floats per vector
  bool pairs;  // a weight is two integers, those of a pair of inputs
  void (*multiply)(const LayerTile&);
  void (*add_pairs)(const PairTile&);
  void (*finish)(const ResultTile&);
  // Chains of multiplications with addition, in registers only. The result keeps the compiler from removing them.
  float (*exercise)(long iterations, float factor);
};
constexpr int exercise_chains = 12;

// LayerTile with integer weights in pairs, without a mask.
void multiply_int16(const LayerTile&);

// Throws Error where the machine does not have the set.
const EngineKernels& kernels_for(InstructionSet);

}  // namespace selvedge
